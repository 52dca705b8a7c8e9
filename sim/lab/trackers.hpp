// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "control/lookahead_rover/rover_tracker.hpp"
#include "control/pure_pursuit/pure_pursuit.hpp"
#include "control/speed_limits.hpp"
#include "sim/simulated_vehicle.hpp"

namespace headland {

/// The trackers' settings; the vehicle's kinematics says which one drives.
struct ControlConfig {
  PurePursuitConfig pure_pursuit;
  RoverTrackerConfig rover;
  SpeedLimitConfig limits;

  template <class V>
  void visit(V& v) {
    v("pure_pursuit", pure_pursuit, "Of Ackermann vehicles");
    v("rover", rover, "Of differential vehicles");
    v("limits", limits, "What slows the vehicle down below its legs' speeds");
  }
};

/// Pure pursuit for Ackermann, the rover tracker for differential kinematics; a filter that is told
/// no accuracy takes that of the simulated fixes.
std::unique_ptr<Tracker> make_tracker(const Vehicle& vehicle, ControlConfig control,
                                      const SensorConfig& sensors);

}  // namespace headland
