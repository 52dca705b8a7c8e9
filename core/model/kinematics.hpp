// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/pose2.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

/// What a controller asks of the vehicle, whatever its kind: the speed along the heading (negative:
/// reverse) and the steering. An Ackermann vehicle takes `steering` (bicycle angle), a differential
/// one `yaw_rate`.
struct Command {
  double speed = 0.0;     ///< [m/s]
  double steering = 0.0;  ///< [rad], positive left; Ackermann only
  double yaw_rate = 0.0;  ///< [rad/s], positive left; differential only
};

/// Motion state of a vehicle.
struct VehicleState {
  Pose2 pose;             ///< T_map_base
  double speed = 0.0;     ///< [m/s], signed
  double steering = 0.0;  ///< actual steering angle [rad]
};

/// Moves the actual steering angle towards `command` for `dt` [s]: first-order lag, then rate
/// limit, then the angle's limit.
double step_steering(const Vehicle& vehicle, double actual, double command, double dt);

/// The state after `dt` [s] under a held command. Speed follows at the vehicle's acceleration,
/// steering through step_steering; the pose moves along the exact arc of the mean speed and the
/// new steering (Ackermann) or of the commanded yaw rate (differential, pivot included).
/// Deterministic, does not allocate.
VehicleState step_vehicle(const Vehicle& vehicle, const VehicleState& state, const Command& command,
                          double dt);

/// Wheel speeds [rad/s] of a differential vehicle (Cornejo et al. 2018, with the half track that
/// seed 004's Eqs. 1-2 leave out).
struct WheelSpeeds {
  double left = 0.0;
  double right = 0.0;
};
WheelSpeeds wheel_speeds(double speed, double yaw_rate, double track_width, double wheel_radius);

}  // namespace headland
