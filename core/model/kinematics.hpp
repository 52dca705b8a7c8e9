// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/pose2.hpp"
#include "core/model/slip.hpp"
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
  double speed = 0.0;     ///< of the wheels [m/s], signed
  double steering = 0.0;  ///< actual steering angle [rad]; Ackermann
  double yaw_rate = 0.0;  ///< of the wheels [rad/s]; differential
};

/// Whether all of it are numbers.
bool is_finite(const VehicleState& state);

/// What a controller goes by: the state as measured or estimated, and the slip if it is known.
struct VehicleEstimate {
  VehicleEstimate() = default;
  /// Converts on purpose: no slip.
  VehicleEstimate(const VehicleState& measured) : state(measured) {}
  VehicleEstimate(const VehicleState& measured, const Slip& known) : state(measured), slip(known) {}

  VehicleState state;
  Slip slip;
};

/// Moves the actual steering angle towards `command` for `dt` [s]: first-order lag, then rate
/// limit, then the angle's limit.
double step_steering(const Vehicle& vehicle, double actual, double command, double dt);

/// The speed of the wheels after `dt` [s]: first-order lag, then the limit of acceleration.
double step_speed(const Vehicle& vehicle, double actual, double command, double dt);

/// The yaw rate of a differential vehicle's wheels after `dt` [s]: the lag of the steering, then
/// the limit of yaw acceleration.
double step_yaw_rate(const Vehicle& vehicle, double actual, double command, double dt);

/// The command that brings an actuator to `wanted` after `dt` [s] in spite of its first-order lag
/// [s]; its limits aside.
double command_through_lag(double wanted, double actual, double lag, double dt);

/// The state after `dt` [s] under a held command, which acts at once (dead times are the caller's:
/// CommandDelay). Speed, steering and yaw rate as in the functions above; the pose moves along the
/// exact arc of the mean speed and the new steering (Ackermann) or yaw rate (differential, pivot
/// included), bent and shortened by the slip as in MotionModel. Deterministic, does not allocate.
VehicleState step_vehicle(const Vehicle& vehicle, const VehicleState& state, const Command& command,
                          double dt, const Slip& slip = {});

/// Wheel speeds [rad/s] of a differential vehicle (Cornejo et al. 2018, with the half track that
/// seed 004's Eqs. 1-2 leave out).
struct WheelSpeeds {
  double left = 0.0;
  double right = 0.0;
};
WheelSpeeds wheel_speeds(double speed, double yaw_rate, double track_width, double wheel_radius);

}  // namespace headland
