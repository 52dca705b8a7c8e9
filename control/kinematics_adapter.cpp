// SPDX-License-Identifier: Apache-2.0
#include "control/kinematics_adapter.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kTwinSteering = 75.0;     // [deg]
constexpr double kTwinSteeringRate = 3.0;  // [rad/s]
constexpr double kStanding = 1e-6;         // [m/s]

}  // namespace

Vehicle KinematicsAdapter::twin(const Vehicle& vehicle) {
  Vehicle other = vehicle;
  if (vehicle.steering == Steering::kAckermann) {
    other.steering = Steering::kDifferential;
    other.min_turning_radius_m = vehicle.turning_radius();
    return other;
  }
  other.steering = Steering::kAckermann;
  other.max_steering_deg = kTwinSteering;
  other.steering_rate_radps = kTwinSteeringRate;
  other.steering_lag_s = 0.0;
  return other;
}

Result<void> KinematicsAdapter::do_start() {
  angle_ = 0.0;
  return tracker_->start(reference());
}

TrackOutput KinematicsAdapter::do_step(const VehicleEstimate& estimate, double dt) {
  VehicleEstimate shown = estimate;
  VehicleState& state = shown.state;
  const double length = vehicle_.wheelbase_m;
  if (vehicle_.steering == Steering::kAckermann) {
    state.yaw_rate = state.speed * std::tan(state.steering) / length;
    TrackOutput output = tracker_->step(shown, dt);
    Command& command = output.command;
    const double limit = vehicle_.max_steering_rad();
    command.steering = estimate.state.steering;
    if (std::abs(command.speed) > kStanding) {
      const double angle = std::atan(length * command.yaw_rate / command.speed);
      command.steering = std::clamp(angle, -limit, limit);
    }
    command.yaw_rate = 0.0;
    return output;
  }
  state.steering = angle_;
  TrackOutput output = tracker_->step(shown, dt);
  angle_ = step_steering(twin_, angle_, output.command.steering, dt);
  output.command.yaw_rate = output.command.speed * std::tan(angle_) / length;
  output.command.steering = 0.0;
  return output;
}

}  // namespace headland
