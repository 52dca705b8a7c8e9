// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/trackers.hpp"
#include "control/lookahead_rover/rover_tracker.hpp"
namespace headland {
std::unique_ptr<Tracker> make_tracker(const Vehicle& vehicle, const SensorConfig& sensors) {
  RoverTrackerConfig config;
  config.filter.fix_accuracy_m = sensors.position_accuracy_m;
  return std::make_unique<RoverTracker>(vehicle, config);
}
}
