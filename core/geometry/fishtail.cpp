// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/fishtail.hpp"

#include "core/geometry/internal/steering.hpp"

namespace headland {
namespace {

// L+ S- L+: the link of the left circles is w = -p e^(i t) with p > 0 the straight, t + q = phi.
std::optional<Curve> one_sided(const internal::UnitGoal& goal, double side,
                               const SmoothTurn& turn) {
  const internal::Link w = internal::left_to_left(goal, turn.ahead(), turn.aside());
  const internal::TurnSector sector = internal::turn_sector(goal, false);
  const double straight = std::sqrt(w.squared);
  if (straight <= goal.tolerance || !sector.contains(-w.u, -w.v, goal.tolerance)) return {};
  const double first = sector.first_turn(-w.u, -w.v, goal.tolerance);
  const double last = sector.total() - first;
  if (first < turn.ramp_angle() || last < turn.ramp_angle()) return {};
  const double total = sector.total() + turn.ramp() + straight;
  const double radius = turn.radius();
  const double ramp = turn.ramp() * radius;
  Curve curve;
  if (turn.has_ramps()) curve.add({0.0, ramp, side * turn.sharpness()});
  internal::add_piece(curve, side, first - turn.ramp_angle(), total, goal, radius);
  internal::add_piece(curve, 0.0, -straight, total, goal, radius);
  internal::add_piece(curve, side, last - turn.ramp_angle(), total, goal, radius);
  if (turn.has_ramps()) curve.add({side / radius, ramp, -side * turn.sharpness()});
  return curve;
}

}  // namespace

std::optional<Curve> fishtail(const Pose2& from, const Pose2& to, double radius) {
  return fishtail(from, to, SmoothTurn({1.0 / radius}));
}

std::optional<Curve> fishtail(const Pose2& from, const Pose2& to, const SmoothTurn& turn) {
  const internal::UnitGoal goal = internal::unit_goal(from, to, turn.radius());
  const std::optional<Curve> left = one_sided(goal, 1.0, turn);
  const std::optional<Curve> right = one_sided(internal::mirrored(goal), -1.0, turn);
  if (!left || !right) return left ? left : right;
  return right->length() < left->length() ? right : left;
}

}  // namespace headland
