// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/trackers.hpp"

namespace headland {

std::unique_ptr<Tracker> make_tracker(const Vehicle& vehicle, ControlConfig control,
                                      const SensorConfig& sensors) {
  const auto inform = [&](PositionFilterConfig& filter) {
    if (filter.fix_accuracy_m == 0.0) filter.fix_accuracy_m = sensors.position_accuracy_m;
  };
  if (vehicle.steering == Steering::kAckermann) {
    inform(control.pure_pursuit.filter);
    return std::make_unique<PurePursuit>(vehicle, control.pure_pursuit, control.limits);
  }
  inform(control.rover.filter);
  return std::make_unique<RoverTracker>(vehicle, control.rover, control.limits);
}

}  // namespace headland
