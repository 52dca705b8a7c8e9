// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/pose2.hpp"

#include <gtest/gtest.h>

#include "tests/support/steering_curves.hpp"

namespace headland {
namespace {

void expect_same(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(wrap_angle(a.yaw - b.yaw), 0.0, tolerance);
}

TEST(Pose2, TransformsFormAGroup) {
  RandomStream random(1, "pose2");
  for (int i = 0; i < 1000; ++i) {
    const Pose2 a = test::random_pose(random, 10.0);
    const Pose2 b = test::random_pose(random, 10.0);
    const Pose2 c = test::random_pose(random, 10.0);
    expect_same((a * b) * c, a * (b * c), 1e-13);
    expect_same(a * inverse(a), Pose2{}, 1e-13);
    expect_same(inverse(a * b), inverse(b) * inverse(a), 1e-13);
    expect_same(a * Pose2{}, a, 0.0);
  }
}

TEST(Pose2, MovesPointsAsItMovesPoses) {
  RandomStream random(2, "pose2");
  for (int i = 0; i < 1000; ++i) {
    const Pose2 a = test::random_pose(random, 10.0);
    const Pose2 b = test::random_pose(random, 10.0);
    EXPECT_LT((a * b.position() - (a * b).position()).norm(), 1e-13);
    EXPECT_LT((inverse(a) * (a * b.position()) - b.position()).norm(), 1e-13);
  }
}

TEST(Pose2, LeftIsAQuarterTurnFromTheHeading) {
  const Pose2 east{3.0, 4.0, 0.0};
  EXPECT_EQ(east.heading(), Point2(1.0, 0.0));
  EXPECT_EQ(east.left(), Point2(0.0, 1.0));
  EXPECT_EQ(east.position(), Point2(3.0, 4.0));
  expect_same(reversed(reversed(east)), east, 1e-15);
  EXPECT_NEAR(reversed(east).heading().x(), -1.0, 1e-15);
}

TEST(Pose2, AQuarterCircleEndsWhereItShould) {
  expect_same(advance({}, 0.5, kPi), {2.0, 2.0, 0.5 * kPi}, 1e-15);
  expect_same(advance({}, -0.5, kPi), {2.0, -2.0, -0.5 * kPi}, 1e-15);
  expect_same(advance({}, 0.5, -kPi), {-2.0, 2.0, -0.5 * kPi}, 1e-15);
  expect_same(advance({1.0, 2.0, 0.5 * kPi}, 0.0, -3.0), {1.0, -1.0, 0.5 * kPi}, 1e-15);
}

TEST(Pose2, AdvancingIsAFlow) {
  RandomStream random(3, "pose2");
  for (int i = 0; i < 1000; ++i) {
    const Pose2 start = test::random_pose(random, 10.0);
    const double curvature = random.uniform(-1.0, 1.0);
    const double s1 = random.uniform(-5.0, 5.0);
    const double s2 = random.uniform(-5.0, 5.0);
    expect_same(advance(advance(start, curvature, s1), curvature, s2),
                advance(start, curvature, s1 + s2), 1e-13);
    expect_same(advance(advance(start, curvature, s1), curvature, -s1), start, 1e-13);
  }
}

// Where the series takes over from the sine the two must agree; the textbook form
// sin(k s) / k serves as the oracle, in extended precision.
TEST(Pose2, AdvancingIsSmoothAtZeroCurvature) {
  for (const double curvature : {1e-12, 1e-9, 1e-6, 1.9e-5, 2.1e-5, 1e-4, -1e-4, 1e-3}) {
    const double distance = 10.0;
    const long double k = curvature;
    const long double half = std::sin(0.5L * k * distance);
    const Pose2 reached = advance({}, curvature, distance);
    EXPECT_NEAR(reached.x, static_cast<double>(std::sin(k * distance) / k), 1e-14) << curvature;
    EXPECT_NEAR(reached.y, static_cast<double>(2.0L * half * half / k), 1e-14) << curvature;
    EXPECT_DOUBLE_EQ(reached.yaw, curvature * distance);
  }
}

}  // namespace
}  // namespace headland
