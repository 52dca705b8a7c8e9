// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/random.hpp"
#include "core/geometry/curve.hpp"

// Queries of which an answer is known: the end of a curve made up at random. Shared by tests and
// benchmarks.
namespace headland::test {

inline Pose2 random_pose(RandomStream& random, double half_side) {
  return {random.uniform(-half_side, half_side), random.uniform(-half_side, half_side),
          random.uniform(-kPi, kPi)};
}

/// A curve of at most three forward pieces, half of them arcs of a special angle.
inline Curve random_forward_construction(RandomStream& random, double radius) {
  constexpr double kSpecial[] = {0.25 * kPi, 0.5 * kPi, kPi, 1.5 * kPi, 1.0};
  Curve curve;
  const int pieces = 1 + random.index(3);
  for (int i = 0; i < pieces; ++i) {
    const int turn = random.index(3) - 1;
    const bool special = random.index(2) == 0;
    const double angle = special ? kSpecial[random.index(5)] : random.uniform(0.0, 2.0 * kPi);
    const double length = turn == 0 ? random.uniform(0.0, 10.0) : angle * radius;
    curve.add({static_cast<double>(turn) / radius, length});
  }
  return curve;
}

/// A curve of at most five pieces in either gear, arcs of up to half a turn.
inline Curve random_reversing_construction(RandomStream& random, double radius) {
  constexpr double kSpecial[] = {0.25 * kPi, 0.5 * kPi, kPi, 1.0, kPi / 3.0};
  Curve curve;
  const int pieces = 1 + random.index(5);
  for (int i = 0; i < pieces; ++i) {
    const int turn = random.index(3) - 1;
    const double gear = random.index(2) == 0 ? 1.0 : -1.0;
    const bool special = random.index(2) == 0;
    const double angle = special ? kSpecial[random.index(5)] : random.uniform(0.0, kPi);
    const double length = turn == 0 ? random.uniform(0.0, 10.0) : angle * radius;
    curve.add({static_cast<double>(turn) / radius, gear * length});
  }
  return curve;
}

}  // namespace headland::test
