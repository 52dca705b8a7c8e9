// SPDX-License-Identifier: Apache-2.0
#pragma once

// What Dubins, Reeds-Shepp and fishtail curves share: the problem in the start's frame with the
// turning radius as unit of length.
//
// Vectors between turning circles are complex numbers: with z = x + i y the goal's position and phi
// its heading, the left circles lie at i and z + i e^(i phi), the right ones at -i and
// z - i e^(i phi).

#include <cmath>

#include "core/geometry/curve.hpp"

namespace headland::internal {

inline constexpr double kTwoPi = 2.0 * kPi;

/// How far [m, rad] an answer may miss the goal to be the limit of a shorter word: less than the
/// promised 1e-9, and far above the rounding of coordinates up to some 10 km.
inline constexpr double kReachTolerance = 4e-10;

/// Goal in the start's frame, lengths in turning radii.
struct UnitGoal {
  double x = 0.0;
  double y = 0.0;
  double phi = 0.0;  ///< heading [rad] in (-pi, pi]
  double sin_phi = 0.0;
  double cos_phi = 1.0;
  double tolerance = kReachTolerance;  ///< kReachTolerance in turning radii
};

inline UnitGoal unit_goal(const Pose2& from, const Pose2& to, double radius) {
  const double scale = 1.0 / radius;
  const double dx = (to.x - from.x) * scale;
  const double dy = (to.y - from.y) * scale;
  const double c = std::cos(from.yaw);
  const double s = std::sin(from.yaw);
  double phi = to.yaw - from.yaw;
  if (!(phi > -kPi && phi <= kPi)) phi = wrap_angle(phi);
  return {c * dx + s * dy, c * dy - s * dx, phi,
          std::sin(phi),   std::cos(phi),   kReachTolerance * scale};
}

/// Appends a piece [radii] unless it is nothing but rounding: it is left out where that moves the
/// end of a curve of `total` radii by far less than an answer may miss the goal. Whoever drives
/// the curve would take such a piece for a jump of the steering, or for a change of gear.
inline void add_piece(Curve& curve, double turn, double length, double total, const UnitGoal& goal,
                      double radius) {
  if (std::abs(length) * (total + 2.0) <= 0.5 * goal.tolerance) return;
  curve.add({turn / radius, length * radius});
}

/// The vector between the turning circles of one side and its length.
struct Link {
  double u = 0.0;
  double v = 0.0;
  double squared = 0.0;
};

inline Link link(double u, double v) { return {u, v, u * u + v * v}; }

// From the start's circle to the goal's; right-handed words are the left-handed ones of the
// mirrored problem, so the right-hand links come mirrored.
inline Link left_to_left(const UnitGoal& g) { return link(g.x - g.sin_phi, g.y - 1.0 + g.cos_phi); }
inline Link left_to_right(const UnitGoal& g) {
  return link(g.x + g.sin_phi, g.y - 1.0 - g.cos_phi);
}
inline Link mirrored_right_to_right(const UnitGoal& g) {
  return link(g.x + g.sin_phi, g.cos_phi - 1.0 - g.y);
}
inline Link mirrored_right_to_left(const UnitGoal& g) {
  return link(g.x - g.sin_phi, -g.y - 1.0 - g.cos_phi);
}

/// The mirrored problem: left turns for right ones.
inline UnitGoal mirrored(const UnitGoal& g) {
  UnitGoal goal = g;
  goal.y = -g.y;
  goal.phi = g.phi == kPi ? kPi : -g.phi;
  goal.sin_phi = -g.sin_phi;
  return goal;
}

/// From the centre of a left turn that begins at the start, `ahead` of it and `aside`, to the
/// centre of one that ends at the goal, as far behind that.
inline Link left_to_left(const UnitGoal& g, double ahead, double aside) {
  return link(g.x - ahead - ahead * g.cos_phi - aside * g.sin_phi,
              g.y - aside - ahead * g.sin_phi + aside * g.cos_phi);
}
/// To the centre of a right turn that ends at the goal.
inline Link left_to_right(const UnitGoal& g, double ahead, double aside) {
  return link(g.x - ahead - ahead * g.cos_phi + aside * g.sin_phi,
              g.y - aside - ahead * g.sin_phi - aside * g.cos_phi);
}

/// The angle [rad] in [0, 2 pi), for angles in [-4 pi, 4 pi].
inline double positive(double angle) {
  while (angle < 0.0) angle += kTwoPi;
  while (angle >= kTwoPi) angle -= kTwoPi;
  return angle;
}

/// Turns of one side that add up to `total`: the first, towards the direction of a link, and the
/// rest. Where the direction lies outside of the sector [0, total] by no more than the tolerance
/// allows, the nearer border takes its place: a turn of nothing never becomes a full circle.
class TurnSector {
 public:
  /// @param total [rad] in [0, 2 pi), its sine and cosine.
  TurnSector(double total, double sin_total, double cos_total)
      : total_(total), sin_(sin_total), cos_(cos_total) {}

  double total() const { return total_; }

  bool contains(double u, double v, double tolerance) const {
    const double before_end = u * sin_ - v * cos_;  // > 0: the border `total` lies to the left
    const bool inside = total_ <= kPi ? total_ > tolerance && v >= 0.0 && before_end >= 0.0
                                      : v >= 0.0 || before_end >= 0.0;
    return inside || (std::abs(v) <= tolerance && u > 0.0) ||
           (std::abs(before_end) <= tolerance && u * cos_ + v * sin_ > 0.0) ||
           u * u + v * v <= 0.25 * tolerance * tolerance;
  }

  /// The first turn towards (u, v), given that the sector contains it.
  double first_turn(double u, double v, double tolerance) const {
    if (u * u + v * v <= 0.25 * tolerance * tolerance) return 0.0;
    const double angle = positive(std::atan2(v, u));
    if (angle <= total_) return angle;
    return kTwoPi - angle < angle - total_ ? 0.0 : total_;
  }

 private:
  double total_;
  double sin_;
  double cos_;
};

/// The sector of all left turns from the start's heading to the goal's; `mirrored` for right turns.
inline TurnSector turn_sector(const UnitGoal& g, bool mirrored) {
  const double phi = mirrored ? -g.phi : g.phi;
  const double total = phi < -kReachTolerance ? phi + kTwoPi : std::max(phi, 0.0);
  return {total, mirrored ? -g.sin_phi : g.sin_phi, g.cos_phi};
}

}  // namespace headland::internal
