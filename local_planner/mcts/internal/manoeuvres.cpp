// SPDX-License-Identifier: Apache-2.0
#include "local_planner/mcts/internal/manoeuvres.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace headland::mcts {
namespace {

constexpr double kStill = 0.05;  // slower may change gear [m/s]
constexpr std::array<double, Manoeuvres::kTurns> kTurnParts{-1.0, -1.0 / 3.0, 0.0, 1.0 / 3.0, 1.0};

using Order = std::array<std::array<int, Manoeuvres::kCount>, Manoeuvres::kCount>;

Order nearest_first() {
  Order order{};
  for (int number = 0; number < Manoeuvres::kCount; ++number) {
    auto& row = order[static_cast<std::size_t>(number)];
    std::iota(row.begin(), row.end(), 0);
    const auto off = [number](int other) {
      const int turn = other / Manoeuvres::kSpeeds - number / Manoeuvres::kSpeeds;
      const int speed = other % Manoeuvres::kSpeeds - number % Manoeuvres::kSpeeds;
      return 2 * (turn * turn + speed * speed) + (speed > 0 ? 1 : 0);
    };
    std::stable_sort(row.begin(), row.end(), [&](int a, int b) { return off(a) < off(b); });
  }
  return order;
}

}  // namespace

const Order Manoeuvres::kOrder = nearest_first();

Manoeuvres::Manoeuvres(const Vehicle& vehicle, double step_s)
    : ackermann_(vehicle.steering == Steering::kAckermann),
      wheelbase_(vehicle.wheelbase_m),
      step_s_(step_s),
      acceleration_(vehicle.acceleration_mps2),
      turn_rate_(ackermann_ ? vehicle.steering_rate_radps : vehicle.yaw_acceleration_radps2),
      track_(vehicle.track_width_m),
      top_speed_(
          std::max({vehicle.work_speed_mps, vehicle.transit_speed_mps, vehicle.turn_speed_mps})) {
  // A differential vehicle's wheels go in opposite directions at the top speed, no faster.
  turn_limit_ = ackermann_ ? vehicle.max_steering_rad() : 2.0 * top_speed_ / track_;
  radius_ = ackermann_ ? wheelbase_ / std::tan(turn_limit_) : 0.0;
  const double reverse = vehicle.reverse_speed_mps > 0.0 ? vehicle.reverse_speed_mps : top_speed_;
  reverse_speed_ = vehicle.can_reverse ? reverse : 0.0;
  turn_rate_ = std::min(turn_rate_, 2.0 * turn_limit_ / step_s);
}

Motion Manoeuvres::from(const VehicleState& state) const {
  const double turn = ackermann_ ? state.steering : state.yaw_rate;
  return {state.pose.x,
          state.pose.y,
          std::cos(state.pose.yaw),
          std::sin(state.pose.yaw),
          state.speed,
          std::clamp(turn, -turn_limit_, turn_limit_)};
}

VehicleState Manoeuvres::to_state(const Motion& m) const {
  VehicleState state;
  state.pose = {m.x, m.y, std::atan2(m.s, m.c)};
  state.speed = m.speed;
  (ackermann_ ? state.steering : state.yaw_rate) = m.turn;
  return state;
}

Command Manoeuvres::command(const Vehicle& vehicle, const VehicleState& now, const Action& action,
                            double dt) const {
  const auto towards = [dt](double from, double to, double rate) {
    return from + std::clamp(to - from, -rate * dt, rate * dt);
  };
  const double speed = towards(now.speed, action.speed, acceleration_);
  const double from = ackermann_ ? now.steering : now.yaw_rate;
  const double turn = towards(from, action.turn, turn_rate_);
  Command command{command_through_lag(speed, now.speed, vehicle.speed_lag_s, dt), 0.0, 0.0};
  (ackermann_ ? command.steering : command.yaw_rate) =
      command_through_lag(turn, from, vehicle.steering_lag_s, dt);
  return command;
}

Action Manoeuvres::action(const Motion& from, int number, double wanted) const {
  const auto turn = static_cast<std::size_t>(number / kSpeeds);
  const double change = acceleration_ * step_s_;
  Action action{from.speed, from.turn + kTurnParts[turn] * turn_rate_ * step_s_};
  switch (number % kSpeeds) {
    case 0:  // to a stand first; from there, backwards
      action.speed = from.speed > kStill
                         ? std::max(0.0, from.speed - change)
                         : std::max(-std::min(reverse_speed_, wanted), from.speed - change);
      break;
    case 2:
      action.speed = from.speed < -kStill
                         ? std::min(0.0, from.speed + change)
                         : std::min(std::max(wanted, from.speed - change), from.speed + change);
      break;
    default:
      action.speed = std::min(from.speed, std::max(wanted, from.speed - change));
      break;
  }
  double most = turn_limit_;
  if (!ackermann_) most = std::min(most, 2.0 * (top_speed_ - std::abs(action.speed)) / track_);
  action.turn = std::clamp(action.turn, -std::max(0.0, most), std::max(0.0, most));
  return action;
}

int Manoeuvres::turn_index(const Motion& from, double turn) const {
  const double part = (turn - from.turn) / (turn_rate_ * step_s_);
  if (part > 2.0 / 3.0) return 4;
  if (part > 1.0 / 6.0) return 3;
  if (part < -2.0 / 3.0) return 0;
  return part < -1.0 / 6.0 ? 1 : 2;
}

int Manoeuvres::backwards(const Motion& from, double place_x, double place_y) const {
  const double dx = place_x - from.x;
  const double dy = place_y - from.y;
  const double left = -from.s * dx + from.c * dy;
  const double curvature = 2.0 * left / std::max(dx * dx + dy * dy, 0.01);
  const double turn = ackermann_ ? std::atan(wheelbase_ * curvature) : from.speed * curvature;
  return turn_index(from, turn) * kSpeeds;
}

int Manoeuvres::towards(const Motion& from, double place_x, double place_y, double wanted) const {
  const double dx = place_x - from.x;
  const double dy = place_y - from.y;
  const double ahead = from.c * dx + from.s * dy;
  const double left = -from.s * dx + from.c * dy;
  const double squared = std::max(dx * dx + dy * dy, 0.01);
  double turn = 0.0;
  if (ackermann_) {
    // The arc through the place (pure pursuit); behind the vehicle, the tightest towards it.
    const double curvature = 2.0 * left / squared;
    turn = ahead > 0.0 ? std::atan(wheelbase_ * curvature) : std::copysign(turn_limit_, left);
  } else {
    turn = std::atan2(left, ahead) / (2.0 * step_s_);
  }
  // A differential vehicle that looks away turns first.
  const double speed = !ackermann_ && ahead < 0.5 * std::sqrt(squared) ? 0.0 : wanted;
  const double tolerance = 0.3 * acceleration_ * step_s_;
  const int pace = from.speed < speed - tolerance ? 2 : from.speed > speed + tolerance ? 0 : 1;
  return turn_index(from, turn) * kSpeeds + pace;
}

Action Manoeuvres::braking(const Motion& from) const {
  const double change = acceleration_ * step_s_;
  const double speed =
      from.speed > 0.0 ? std::max(0.0, from.speed - change) : std::min(0.0, from.speed + change);
  if (ackermann_) return {speed, from.turn};
  return {speed, std::abs(from.speed) > 1e-6 ? from.turn * speed / from.speed : 0.0};
}

Motion Manoeuvres::drive(const Motion& from, const Action& action) const {
  Motion to = from;
  to.speed = action.speed;
  to.turn = action.turn;
  // Each changes at its fastest rate and then holds, so that the mean lies nearer to the end.
  const double speed_time = std::min(step_s_, std::abs(to.speed - from.speed) / acceleration_);
  const double turn_time = std::min(step_s_, std::abs(to.turn - from.turn) / turn_rate_);
  const double mean_speed = to.speed + 0.5 * (from.speed - to.speed) * speed_time / step_s_;
  const double mean_turn = to.turn + 0.5 * (from.turn - to.turn) * turn_time / step_s_;
  const double distance = mean_speed * step_s_;
  // tan by its series: within 3e-4 up to 0.7 rad.
  const double t2 = mean_turn * mean_turn;
  const double tangent =
      mean_turn * (1.0 + t2 * (1.0 / 3.0 + t2 * (2.0 / 15.0 + t2 * (17.0 / 315.0 + t2 * 0.0219))));
  const double angle = ackermann_ ? distance * tangent / wheelbase_ : mean_turn * step_s_;
  // The chord of the arc, and the heading turned by it.
  const double half = 0.5 * angle;
  const double h2 = half * half;
  double sin_half = half * (1.0 - h2 * (1.0 / 6.0 - h2 / 120.0));
  double cos_half = 1.0 - h2 * (0.5 - h2 * (1.0 / 24.0 - h2 / 720.0));
  if (h2 > 0.25) {
    sin_half = std::sin(half);
    cos_half = std::cos(half);
  }
  const double chord = distance * (1.0 - h2 * (1.0 / 6.0 - h2 / 120.0));
  const double c = from.c * cos_half - from.s * sin_half;
  const double s = from.s * cos_half + from.c * sin_half;
  to.x = from.x + chord * c;
  to.y = from.y + chord * s;
  const double cc = c * cos_half - s * sin_half;
  const double ss = s * cos_half + c * sin_half;
  const double trim = 1.5 - 0.5 * (cc * cc + ss * ss);
  to.c = cc * trim;
  to.s = ss * trim;
  return to;
}

}  // namespace headland::mcts
