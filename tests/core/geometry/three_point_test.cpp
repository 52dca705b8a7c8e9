// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/three_point.hpp"

#include "tests/support/steering_curves.hpp"

namespace headland {
namespace {

TEST(ThreePoint, BetweenNearRowsIsHalfATurnInAllWithoutClothoids) {
  const SmoothTurn turn({0.5});
  for (const double apart : {0.5, 1.0, 2.0, 3.9}) {
    const Pose2 to{0.0, apart, kPi};
    const auto curve = three_point_turn({}, to, turn, 1.0);
    ASSERT_TRUE(curve);
    EXPECT_EQ(curve->word(), "L+R-L+");
    EXPECT_NEAR(curve->length(), 2.0 * kPi, 1e-9);
    EXPECT_TRUE(test::obeys_the_laws(*curve, {}, to, 2.0));
  }
}

TEST(ThreePoint, BeginsAndEndsWithStraightWheels) {
  const SmoothTurn turn({0.5, 0.5});
  const Pose2 to{0.0, 2.5, kPi};
  const auto curve = three_point_turn({}, to, turn, 1.0);
  ASSERT_TRUE(curve);
  EXPECT_EQ(curve->word(), "L+L+R-L+L+");
  EXPECT_TRUE(test::obeys_the_smooth_laws(*curve, {}, to, turn));
  // Each clothoid is longer by half than the arc that it stands for.
  EXPECT_NEAR(curve->length(), 2.0 * (kPi + turn.ramp()), 1e-9);
}

TEST(ThreePoint, ObeysTheLawsWhereverItExists) {
  RandomStream random(1, "three point");
  for (const double sharpness : {0.1, 0.5, 5.0}) {
    const SmoothTurn turn({0.5, sharpness});
    int found = 0;
    for (int i = 0; i < 10000; ++i) {
      const Pose2 from = test::random_pose(random, 4.0);
      const Pose2 to = test::random_pose(random, 4.0);
      const auto curve = three_point_turn(from, to, turn, 1.0);
      const auto image = three_point_turn(test::mirrored(from), test::mirrored(to), turn, -1.0);
      ASSERT_EQ(curve.has_value(), image.has_value());
      if (!curve) continue;
      ++found;
      ASSERT_TRUE(test::obeys_the_smooth_laws(*curve, from, to, turn)) << i;
      ASSERT_NEAR(curve->length(), image->length(), 1e-9);
    }
    EXPECT_GT(found, 1000);
  }
}

TEST(ThreePoint, IsNoneBetweenPosesFarApart) {
  EXPECT_FALSE(three_point_turn({}, {20.0, 0.0, 0.0}, SmoothTurn({0.5}), 1.0));
}

}  // namespace
}  // namespace headland
