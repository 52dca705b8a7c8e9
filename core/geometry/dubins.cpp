// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/dubins.hpp"

#include <algorithm>
#include <limits>

#include "core/geometry/internal/steering.hpp"

// The turns of LSL and LRL add up to a known angle, but for a full circle; whether the circle is
// needed is a question of sectors, and no arc tangent is taken for a word that does not win.
namespace headland {
namespace {

using internal::kTwoPi;
using internal::Link;
using internal::positive;
using internal::UnitGoal;

enum class Word { kSameSide, kOtherSide, kThreeArcs };  // LSL, LSR, LRL and their mirror images

struct Solution {
  double length = std::numeric_limits<double>::infinity();  // in radii
  Word word = Word::kSameSide;
  bool mirrored = false;
  bool full_circle = false;  // LSL and LRL: the outer turns make a full circle more
  double first = 0.0;        // LSR: first turn; LRL: half of what the middle turn exceeds pi by
};

// LSL: w = p e^(i t), t + q = phi.
void try_same_side(const UnitGoal& goal, const Link& w, bool mirrored, Solution& best) {
  const internal::TurnSector sector = internal::turn_sector(goal, mirrored);
  double length = std::sqrt(w.squared) + sector.total();
  if (length >= best.length) return;
  const bool full_circle = !sector.contains(w.u, w.v, goal.tolerance);
  if (full_circle) length += kTwoPi;
  if (length < best.length) best = {length, Word::kSameSide, mirrored, full_circle, 0.0};
}

// LSR: w = e^(i t) (p - 2 i), q = t - phi.
void try_other_side(const UnitGoal& goal, const Link& w, bool mirrored, Solution& best) {
  const double slack = 4.0 * goal.tolerance;  // circles that overlap by the tolerance do touch
  if (w.squared < 4.0 - slack) return;
  const double p = std::sqrt(std::max(w.squared - 4.0, 0.0));
  if (p + std::abs(goal.phi) >= best.length) return;
  double t = positive(std::atan2(w.v * p + 2.0 * w.u, w.u * p - 2.0 * w.v));
  if ((kTwoPi - t) * (p + 2.0) <= goal.tolerance) t = 0.0;
  double q = positive(t - (mirrored ? -goal.phi : goal.phi));
  if (kTwoPi - q <= std::min(goal.tolerance, internal::kReachTolerance)) q = 0.0;
  const double length = t + p + q;
  if (length < best.length) best = {length, Word::kOtherSide, mirrored, false, t};
}

struct OuterTurns {
  double middle;
  internal::TurnSector sector;
  double u;  // direction of the first turn
  double v;
};

// LRL: w = -4 sin(p / 2) e^(i (t - p / 2)) with p > pi, so p = pi + 2 a with cos(a) = |w| / 4, and
// t = arg(w) + a + pi / 2, t + q = phi + p.
OuterTurns outer_turns(const UnitGoal& goal, const Link& w, bool mirrored, double a) {
  const double middle = kPi + 2.0 * a;
  double total = positive((mirrored ? -goal.phi : goal.phi) + middle);
  if (kTwoPi - total <= internal::kReachTolerance) total = 0.0;
  const double s = std::sin(a);
  const double c = std::cos(a);
  return {middle, {total, std::sin(total), std::cos(total)}, -w.u * s - w.v * c, w.u * c - w.v * s};
}

void try_three_arcs(const UnitGoal& goal, const Link& w, bool mirrored, Solution& best) {
  if (w.squared >= 16.0 || best.length <= kPi) return;
  const double a = std::acos(0.25 * std::sqrt(w.squared));
  const double middle = kPi + 2.0 * a;
  if (middle >= best.length) return;
  const OuterTurns turns = outer_turns(goal, w, mirrored, a);
  double length = middle + turns.sector.total();
  if (length >= best.length) return;
  const bool full_circle = !turns.sector.contains(turns.u, turns.v, goal.tolerance);
  if (full_circle) length += kTwoPi;
  if (length < best.length) best = {length, Word::kThreeArcs, mirrored, full_circle, a};
}

Solution solve(const UnitGoal& goal) {
  Solution best;
  const Link left = internal::left_to_left(goal);
  const Link right = internal::mirrored_right_to_right(goal);
  try_same_side(goal, left, false, best);
  try_same_side(goal, right, true, best);
  try_other_side(goal, internal::left_to_right(goal), false, best);
  try_other_side(goal, internal::mirrored_right_to_left(goal), true, best);
  try_three_arcs(goal, left, false, best);
  try_three_arcs(goal, right, true, best);
  return best;
}

double first_turn(const internal::TurnSector& sector, double u, double v, bool full_circle,
                  double tolerance) {
  return full_circle ? positive(std::atan2(v, u)) : sector.first_turn(u, v, tolerance);
}

Curve build(const UnitGoal& goal, const Solution& found, double radius) {
  const double side = found.mirrored ? -1.0 : 1.0;
  const double extra = found.full_circle ? kTwoPi : 0.0;
  const Link same =
      found.mirrored ? internal::mirrored_right_to_right(goal) : internal::left_to_left(goal);
  Curve curve;
  const auto add = [&](double turn, double length) {
    internal::add_piece(curve, turn, length, found.length, goal, radius);
  };
  if (found.word == Word::kSameSide) {
    const internal::TurnSector sector = internal::turn_sector(goal, found.mirrored);
    const double t = first_turn(sector, same.u, same.v, found.full_circle, goal.tolerance);
    add(side, t);
    add(0.0, std::sqrt(same.squared));
    add(side, sector.total() + extra - t);
  } else if (found.word == Word::kOtherSide) {
    const Link other =
        found.mirrored ? internal::mirrored_right_to_left(goal) : internal::left_to_right(goal);
    const double p = std::sqrt(std::max(other.squared - 4.0, 0.0));
    add(side, found.first);
    add(0.0, p);
    add(-side, found.length - p - found.first);
  } else {
    const OuterTurns turns = outer_turns(goal, same, found.mirrored, found.first);
    const double t = first_turn(turns.sector, turns.u, turns.v, found.full_circle, goal.tolerance);
    add(side, t);
    add(-side, turns.middle);
    add(side, turns.sector.total() + extra - t);
  }
  return curve;
}

}  // namespace

Curve shortest_dubins(const Pose2& from, const Pose2& to, double radius) {
  const UnitGoal goal = internal::unit_goal(from, to, radius);
  return build(goal, solve(goal), radius);
}

double dubins_length(const Pose2& from, const Pose2& to, double radius) {
  return solve(internal::unit_goal(from, to, radius)).length * radius;
}

}  // namespace headland
