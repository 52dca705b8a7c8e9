// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/model/kinematics.hpp"

namespace headland::mcts {

/// A vehicle's state in the tree. `turn` is the steering angle [rad] (Ackermann) or the yaw rate
/// [rad/s] (differential); `c`, `s`: cosine and sine of the heading.
struct Motion {
  double x = 0.0;  ///< of the base [m]
  double y = 0.0;
  double c = 1.0;
  double s = 0.0;
  double speed = 0.0;  ///< [m/s], signed
  double turn = 0.0;
};

/// What is held for one step: where the speed and the turn go to, as fast as they can.
struct Action {
  double speed = 0.0;
  double turn = 0.0;
};

/// The manoeuvres of a vehicle over one step of the tree. Does not allocate.
class Manoeuvres {
 public:
  static constexpr int kTurns = 5;
  static constexpr int kSpeeds = 3;
  static constexpr int kCount = kTurns * kSpeeds;

  Manoeuvres(const Vehicle& vehicle, double step_s);

  double turn_limit() const { return turn_limit_; }  ///< [rad] or [rad/s]
  double radius() const { return radius_; }          ///< tightest at low speed [m]
  bool ackermann() const { return ackermann_; }
  bool reverses() const { return reverse_speed_ > 0.0; }
  double acceleration() const { return acceleration_; }  ///< [m/s2]

  Motion from(const VehicleState& state) const;
  VehicleState to_state(const Motion& motion) const;
  /// The command that leads `now` towards the action for `dt` [s], through the actuators' lags.
  Command command(const Vehicle& vehicle, const VehicleState& now, const Action& action,
                  double dt) const;

  /// The action of that number: turn index - 2 in thirds of what a step can change (-1, -1/3, 0,
  /// 1/3, 1), speed index 0 slower, 1 held, 2 faster up to `wanted` [m/s].
  Action action(const Motion& from, int number, double wanted) const;
  /// The number nearest to heading for `place` [m] with the speed going to `wanted`.
  int towards(const Motion& from, double place_x, double place_y, double wanted) const;
  /// The number nearest to backing up to that place.
  int backwards(const Motion& from, double place_x, double place_y) const;
  /// Braking as hard as it can, the turn held (the curve, that is).
  Action braking(const Motion& from) const;
  /// The number whose turn and speed are the k-th nearest to those of `number`.
  static int nearest(int number, int k) {
    return kOrder[static_cast<std::size_t>(number)][static_cast<std::size_t>(k)];
  }

  /// The state one step on. Speed and turn change evenly over as much of the step as they need;
  /// the pose moves on the arc of their means.
  Motion drive(const Motion& from, const Action& action) const;

 private:
  int turn_index(const Motion& from, double turn) const;
  static const std::array<std::array<int, kCount>, kCount> kOrder;

  bool ackermann_;
  double wheelbase_;
  double step_s_;
  double acceleration_;
  double turn_rate_;
  double turn_limit_;
  double radius_;
  double reverse_speed_;  // most [m/s]; 0: no reverse gear
  double track_;
  double top_speed_;
};

}  // namespace headland::mcts
