// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/curve.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

Curve three_point_turn() {
  Curve curve;
  curve.add({0.5, 2.0});
  curve.add({-0.5, -1.0});
  curve.add({0.0, -0.5});
  curve.add({0.5, 2.0});
  return curve;
}

TEST(Curve, CountsDrivenDistanceInBothGears) {
  EXPECT_DOUBLE_EQ(three_point_turn().length(), 5.5);
  EXPECT_EQ(Curve().length(), 0.0);
}

TEST(Curve, CountsChangesOfGear) {
  EXPECT_EQ(three_point_turn().cusps(), 2);
  EXPECT_EQ(Curve().cusps(), 0);
}

TEST(Curve, SpellsItsWordWithGears) {
  EXPECT_EQ(three_point_turn().word(), "L+R-S-L+");
  EXPECT_EQ(Curve().word(), "");
}

TEST(Curve, DropsPiecesOfNoLength) {
  Curve curve;
  curve.add({0.5, 0.0});
  curve.add({0.0, -0.0});
  EXPECT_EQ(curve.count(), 0);
  EXPECT_EQ(curve.begin(), curve.end());
}

TEST(Curve, EndsWhereItsPiecesLeadOneAfterTheOther) {
  Pose2 pose{3.0, -1.0, 0.4};
  const Pose2 start = pose;
  for (const CurvePiece& piece : three_point_turn()) {
    pose = advance(pose, piece.curvature, piece.length);
  }
  const Pose2 end = three_point_turn().end_pose(start);
  EXPECT_EQ(end.position(), pose.position());
  EXPECT_NEAR(end.yaw, 0.4 + 1.0 + 0.5 + 1.0, 1e-15);
}

TEST(Curve, TheErrorAtItsEndIgnoresWholeTurns) {
  Curve straight;
  straight.add({0.0, 5.0});
  const EndError error = end_error(straight, {}, {8.0, 4.0, 2.0 * kPi - 0.1});
  EXPECT_NEAR(error.position, 5.0, 1e-12);
  EXPECT_NEAR(error.yaw, 0.1, 1e-12);
}

}  // namespace
}  // namespace headland
