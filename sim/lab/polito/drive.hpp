// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "control/lookahead_rover/rover_tracker.hpp"
#include "control/lookahead_rover/seed_lookahead_rover.hpp"
#include "core/geometry/path.hpp"

namespace headland {

/// How the rover moves under a command held for one cycle.
enum class RoverPlant {
  kTurnThenMove,  ///< the whole turn first, then straight, at once at the commanded speed: (004)
  kArc,           ///< the exact arc, with limited acceleration: core/model
};

/// The conditions of one drive.
struct RoverDrive {
  RoverPlant plant = RoverPlant::kTurnThenMove;
  double cycle_s = 0.05;
  double fix_accuracy_m = 0.0;        ///< half width of the fix's uniform error on each axis [m]
  double odometry_scale_ratio = 1.0;  ///< speed told by the odometry over the true one
  double heading_error_rad = 0.0;     ///< measured less true heading
  std::uint64_t seed = 1;             ///< of the fixes' errors
};

/// Where the rover truly was, cycle by cycle, after each command.
struct DrivenTrack {
  std::vector<Point2> positions;
  bool completed = false;  ///< the goal was reached within three times the time it should take
};

/// Drives the seed's follower along its waypoints, from the first one with heading `yaw` [rad].
DrivenTrack drive_seed(const RoverDrive& drive, const SeedLookaheadConfig& config,
                       const std::vector<Point2>& waypoints, double yaw, const Vehicle& vehicle);

/// Drives our tracker along a reference, from its start, standing. The tracker is told the true
/// heading and its own (possibly wrongly scaled) speed, as the seed's rover is, and a noisy fix.
DrivenTrack drive_ours(const RoverDrive& drive, const RoverTrackerConfig& config,
                       const Reference& reference, const Vehicle& vehicle);

}  // namespace headland
