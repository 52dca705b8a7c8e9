// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string_view>

#include <gtest/gtest.h>

#include "core/geometry/smooth_turn.hpp"
#include "tests/support/curve_constructions.hpp"

// What every steering curve must obey.
namespace headland::test {

inline constexpr double kEndTolerance = 1e-9;  // [m, rad]

/// The laws: it ends at `to`, it is no shorter than the chord, it bends no more than the radius
/// allows.
inline ::testing::AssertionResult obeys_the_laws(const Curve& curve, const Pose2& from,
                                                 const Pose2& to, double radius) {
  const EndError error = end_error(curve, from, to);
  // Written so that a NaN fails.
  if (!(error.position <= kEndTolerance && error.yaw <= kEndTolerance)) {
    return ::testing::AssertionFailure() << curve.word() << " misses its end by " << error.position
                                         << " m and " << error.yaw << " rad";
  }
  const double chord = (to.position() - from.position()).norm();
  if (!(curve.length() >= chord - kEndTolerance)) {
    return ::testing::AssertionFailure()
           << curve.word() << " of " << curve.length() << " m is shorter than the chord " << chord;
  }
  for (const CurvePiece& piece : curve) {
    if (!(piece.max_abs_curvature() * radius <= 1.0 + 1e-15)) {
      return ::testing::AssertionFailure() << curve.word() << " bends by " << piece.curvature;
    }
  }
  return ::testing::AssertionSuccess();
}

/// The laws of curves with clothoids too: no sharper than allowed, with the wheels straight at both
/// ends, and of a curvature that steps nowhere inside a gear.
inline ::testing::AssertionResult obeys_the_smooth_laws(const Curve& curve, const Pose2& from,
                                                        const Pose2& to, const SmoothTurn& turn) {
  constexpr double kSame = 1e-11;  // [1/m]
  const auto legal = obeys_the_laws(curve, from, to, turn.radius() * (1.0 - 1e-12));
  if (!legal) return legal;
  double before = 0.0;
  bool forward = true;
  for (const CurvePiece& piece : curve) {
    const bool gear = piece.length > 0.0;
    if (gear == forward && !(std::abs(piece.curvature - before) <= kSame)) {
      return ::testing::AssertionFailure()
             << curve.word() << " steps from " << before << " to " << piece.curvature;
    }
    if (!(std::abs(piece.sharpness) <= turn.sharpness() * (1.0 + 1e-12))) {
      return ::testing::AssertionFailure() << curve.word() << " turns by " << piece.sharpness;
    }
    before = piece.end_curvature();
    forward = gear;
  }
  if (forward && !(std::abs(before) <= kSame)) {
    return ::testing::AssertionFailure() << curve.word() << " ends with " << before;
  }
  return ::testing::AssertionSuccess();
}

/// Mirror image in the x axis; a shortest curve mirrored is a shortest curve.
inline Pose2 mirrored(const Pose2& pose) { return {pose.x, -pose.y, -pose.yaw}; }

/// Asks for the curve to the end of `count` constructed ones: it must obey the laws and be no
/// longer than the construction, by either function.
template <typename Construct, typename Solve, typename Length>
void expect_never_longer_than_constructions(int count, std::string_view name, Construct construct,
                                            Solve solve, Length length) {
  RandomStream random(20261122, name);
  int failures = 0;
  for (int i = 0; i < count && failures < 5; ++i) {
    const double radius = random.uniform(0.5, 6.0);
    const Pose2 from = random_pose(random, 50.0);
    const Curve known = construct(random, radius);
    Pose2 to = known.end_pose(from);
    to.yaw = wrap_angle(to.yaw);
    const Curve found = solve(from, to, radius);
    const ::testing::AssertionResult legal = obeys_the_laws(found, from, to, radius);
    const bool short_enough = found.length() <= known.length() + kEndTolerance;
    const bool agree = std::abs(length(from, to, radius) - found.length()) <= kEndTolerance;
    if (legal && short_enough && agree) continue;
    ++failures;
    ADD_FAILURE() << "query " << i << ": " << legal.message() << "; built " << known.word() << " "
                  << known.length() << " m, found " << found.word() << " " << found.length()
                  << " m, length alone " << length(from, to, radius) << " m";
  }
}

/// Asks for the curve to the end of an arc, a straight, or both: the answer must not hold a piece
/// that is rounding alone. To whoever drives the curve it would be a jump of the steering.
template <typename Solve>
void expect_no_piece_of_rounding(double half_side, std::string_view name, Solve solve) {
  RandomStream random(20261123, name);
  int failures = 0;
  for (int i = 0; i < 20000 && failures < 5; ++i) {
    const Pose2 from = random_pose(random, half_side);
    const CurvePiece arc{random.index(2) == 0 ? 0.5 : -0.5, random.uniform(0.1, 3.0)};
    const CurvePiece straight{0.0, random.uniform(0.1, 30.0)};
    const int kind = random.index(4);
    Curve known;
    if (kind <= 1) known.add(arc);
    if (kind >= 1) known.add(straight);
    if (kind == 3) known.add(arc);
    const Curve found = solve(from, known.end_pose(from), 2.0);
    if (found.count() == known.count()) continue;
    ++failures;
    ADD_FAILURE() << "query " << i << ": built " << known.word() << " and found " << found.word();
  }
}

}  // namespace headland::test
