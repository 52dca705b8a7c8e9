// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/fishtail.hpp"

#include "core/geometry/internal/steering.hpp"

namespace headland {
namespace {

// L+ S- L+: the link of the left circles is w = -p e^(i t) with p > 0 the straight, t + q = phi.
std::optional<Curve> one_sided(const internal::UnitGoal& goal, bool mirrored, double radius) {
  const internal::Link w =
      mirrored ? internal::mirrored_right_to_right(goal) : internal::left_to_left(goal);
  const internal::TurnSector sector = internal::turn_sector(goal, mirrored);
  const double straight = std::sqrt(w.squared);
  if (straight <= goal.tolerance || !sector.contains(-w.u, -w.v, goal.tolerance)) return {};
  const double first = sector.first_turn(-w.u, -w.v, goal.tolerance);
  const double side = mirrored ? -1.0 : 1.0;
  const double total = sector.total() + straight;
  Curve curve;
  internal::add_piece(curve, side, first, total, goal, radius);
  internal::add_piece(curve, 0.0, -straight, total, goal, radius);
  internal::add_piece(curve, side, sector.total() - first, total, goal, radius);
  return curve;
}

}  // namespace

std::optional<Curve> fishtail(const Pose2& from, const Pose2& to, double radius) {
  const internal::UnitGoal goal = internal::unit_goal(from, to, radius);
  const std::optional<Curve> left = one_sided(goal, false, radius);
  const std::optional<Curve> right = one_sided(goal, true, radius);
  if (!left || !right) return left ? left : right;
  return right->length() < left->length() ? right : left;
}

}  // namespace headland
