// SPDX-License-Identifier: Apache-2.0
#include "core/model/kinematics.hpp"

#include <algorithm>
#include <cmath>

namespace headland {

double step_steering(const Vehicle& vehicle, double actual, double command, double dt) {
  const double limit = vehicle.max_steering_rad();
  const double wanted = std::clamp(command, -limit, limit) - actual;
  const double lagged = vehicle.steering_lag_s > 0.0
                            ? wanted * (1.0 - std::exp(-dt / vehicle.steering_lag_s))
                            : wanted;
  const double most = vehicle.steering_rate_radps * dt;
  return std::clamp(actual + std::clamp(lagged, -most, most), -limit, limit);
}

VehicleState step_vehicle(const Vehicle& vehicle, const VehicleState& state, const Command& command,
                          double dt) {
  const double most = vehicle.acceleration_mps2 * dt;
  VehicleState next = state;
  next.speed = state.speed + std::clamp(command.speed - state.speed, -most, most);
  const double distance = 0.5 * (state.speed + next.speed) * dt;
  if (vehicle.steering == Steering::kAckermann) {
    next.steering = step_steering(vehicle, state.steering, command.steering, dt);
    next.pose = advance(state.pose, std::tan(next.steering) / vehicle.wheelbase_m, distance);
  } else {
    const double turn = command.yaw_rate * dt;
    next.steering = 0.0;
    next.pose = std::abs(distance) > 1e-12
                    ? advance(state.pose, turn / distance, distance)
                    : Pose2{state.pose.x, state.pose.y, state.pose.yaw + turn};
  }
  next.pose.yaw = wrap_angle(next.pose.yaw);
  return next;
}

WheelSpeeds wheel_speeds(double speed, double yaw_rate, double track_width, double wheel_radius) {
  const double half = 0.5 * track_width * yaw_rate;
  return {(speed - half) / wheel_radius, (speed + half) / wheel_radius};
}

}  // namespace headland
