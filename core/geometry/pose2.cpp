// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/pose2.hpp"

namespace headland {

Pose2 advance(const Pose2& from, double curvature, double distance) {
  // The chord of the arc has the mean heading and the length distance * sinc(half the turn).
  const double half_turn = 0.5 * curvature * distance;
  const double sinc = std::abs(half_turn) < 1e-4 ? 1.0 - half_turn * half_turn / 6.0
                                                 : std::sin(half_turn) / half_turn;
  const double chord = distance * sinc;
  return {from.x + chord * std::cos(from.yaw + half_turn),
          from.y + chord * std::sin(from.yaw + half_turn), from.yaw + 2.0 * half_turn};
}

}  // namespace headland
