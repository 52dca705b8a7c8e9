// SPDX-License-Identifier: Apache-2.0
#include "control/slip_compensation.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kMostLoss = 0.9;  // a wheel that spins more is not sped up further
// Slower is a standstill: trackers wait for one, and an estimate never quite is [m/s].
constexpr double kStill = 0.02;

}  // namespace

TrackOutput SlipCompensation::do_step(const VehicleEstimate& estimate, double dt) {
  const Slip& slip = estimate.slip;
  const double keep = 1.0 - std::min(slip.loss_ratio, kMostLoss);
  const double side = std::cos(slip.side_rad);
  const double offset = side * std::tan(slip.steering_offset_rad) / vehicle_.wheelbase_m;
  VehicleEstimate ideal(estimate.state);
  VehicleState& state = ideal.state;
  state.pose.yaw = wrap_angle(state.pose.yaw + slip.side_rad);
  state.speed = std::abs(state.speed) < kStill ? 0.0 : state.speed * keep;
  state.steering = std::atan(side * std::tan(state.steering + slip.steering_offset_rad));
  state.yaw_rate = keep * state.yaw_rate + state.speed * offset;
  TrackOutput output = tracker_->step(ideal, dt);
  Command& command = output.command;
  command.yaw_rate = (command.yaw_rate - command.speed * offset) / keep;
  command.speed /= keep;
  if (vehicle_.steering == Steering::kAckermann) {
    const double limit = vehicle_.max_steering_rad();
    const double angle = std::atan(std::tan(command.steering) / side) - slip.steering_offset_rad;
    command.steering = std::clamp(angle, -limit, limit);
  }
  return output;
}

}  // namespace headland
