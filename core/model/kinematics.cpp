// SPDX-License-Identifier: Apache-2.0
#include "core/model/kinematics.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

// What of the way to a command an actuator with a first-order lag makes in `dt`.
double lagged(double way, double lag, double dt) {
  return lag > 0.0 ? way * (1.0 - std::exp(-dt / lag)) : way;
}

}  // namespace

bool is_finite(const VehicleState& state) {
  return std::isfinite(state.pose.x) && std::isfinite(state.pose.y) &&
         std::isfinite(state.pose.yaw) && std::isfinite(state.speed) &&
         std::isfinite(state.steering) && std::isfinite(state.yaw_rate);
}

double step_steering(const Vehicle& vehicle, double actual, double command, double dt) {
  const double limit = vehicle.max_steering_rad();
  const double wanted = std::clamp(command, -limit, limit) - actual;
  const double most = vehicle.steering_rate_radps * dt;
  return std::clamp(actual + std::clamp(lagged(wanted, vehicle.steering_lag_s, dt), -most, most),
                    -limit, limit);
}

double step_speed(const Vehicle& vehicle, double actual, double command, double dt) {
  const double most = vehicle.acceleration_mps2 * dt;
  return actual + std::clamp(lagged(command - actual, vehicle.speed_lag_s, dt), -most, most);
}

double step_yaw_rate(const Vehicle& vehicle, double actual, double command, double dt) {
  const double most = vehicle.yaw_acceleration_radps2 * dt;
  const double way = lagged(command - actual, vehicle.steering_lag_s, dt);
  // An immediate actuator has the command to the last bit.
  if (vehicle.steering_lag_s <= 0.0 && std::abs(way) <= most) return command;
  return actual + std::clamp(way, -most, most);
}

double command_through_lag(double wanted, double actual, double lag, double dt) {
  return lag > 0.0 ? actual + (wanted - actual) / (1.0 - std::exp(-dt / lag)) : wanted;
}

VehicleState step_vehicle(const Vehicle& vehicle, const VehicleState& state, const Command& command,
                          double dt, const Slip& slip) {
  VehicleState next = state;
  next.speed = step_speed(vehicle, state.speed, command.speed, dt);
  const double keep = 1.0 - slip.loss_ratio;
  const double distance = 0.5 * (state.speed + next.speed) * dt * keep;
  const double bend = std::cos(slip.side_rad) / vehicle.wheelbase_m;
  // Along the direction of travel, which the slip turns away from the heading.
  const Pose2 along{state.pose.x, state.pose.y, state.pose.yaw + slip.side_rad};
  if (vehicle.steering == Steering::kAckermann) {
    next.steering = step_steering(vehicle, state.steering, command.steering, dt);
    const double angle = next.steering + slip.steering_offset_rad;
    next.pose = advance(along, bend * std::tan(angle), distance);
  } else {
    next.yaw_rate = step_yaw_rate(vehicle, state.yaw_rate, command.yaw_rate, dt);
    const double turn = keep * next.yaw_rate * dt;
    const double offset = bend * std::tan(slip.steering_offset_rad);
    next.pose = std::abs(distance) > 1e-12 ? advance(along, turn / distance + offset, distance)
                                           : Pose2{state.pose.x, state.pose.y, along.yaw + turn};
  }
  next.pose.yaw = wrap_angle(next.pose.yaw - slip.side_rad);
  return next;
}

WheelSpeeds wheel_speeds(double speed, double yaw_rate, double track_width, double wheel_radius) {
  const double half = 0.5 * track_width * yaw_rate;
  return {(speed - half) / wheel_radius, (speed + half) / wheel_radius};
}

}  // namespace headland
