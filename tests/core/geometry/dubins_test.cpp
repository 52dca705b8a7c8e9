// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/dubins.hpp"

#include <gtest/gtest.h>

#include "tests/support/dubins_oracle.hpp"
#include "tests/support/steering_curves.hpp"

namespace headland {
namespace {

void expect_length(const Pose2& from, const Pose2& to, double radius, double length,
                   double tolerance = 1e-9) {
  const Curve curve = shortest_dubins(from, to, radius);
  EXPECT_TRUE(test::obeys_the_laws(curve, from, to, radius));
  EXPECT_NEAR(curve.length(), length, tolerance) << curve.word();
  EXPECT_NEAR(dubins_length(from, to, radius), length, tolerance);
}

TEST(Dubins, ObeysTheLawsOfSteeringCurvesGoingForwardOnly) {
  RandomStream random(1, "dubins");
  for (int i = 0; i < 20000; ++i) {
    const Pose2 from = test::random_pose(random, 10.0);
    const Pose2 to = test::random_pose(random, 10.0);
    const double radius = random.uniform(0.2, 8.0);
    const Curve curve = shortest_dubins(from, to, radius);
    ASSERT_TRUE(test::obeys_the_laws(curve, from, to, radius)) << i;
    ASSERT_EQ(curve.cusps(), 0);
    for (const CurvePiece& piece : curve) ASSERT_GT(piece.length, 0.0);
    ASSERT_NEAR(dubins_length(from, to, radius), curve.length(), 1e-10);
  }
}

TEST(Dubins, LengthSurvivesReversalMirroringAndScaling) {
  RandomStream random(2, "dubins");
  for (int i = 0; i < 20000; ++i) {
    const Pose2 from = test::random_pose(random, 10.0);
    const Pose2 to = test::random_pose(random, 10.0);
    const double length = dubins_length(from, to, 2.0);
    ASSERT_NEAR(dubins_length(reversed(to), reversed(from), 2.0), length, 1e-9);
    ASSERT_NEAR(dubins_length(test::mirrored(from), test::mirrored(to), 2.0), length, 1e-9);
    const Pose2 far_from{3.0 * from.x, 3.0 * from.y, from.yaw};
    const Pose2 far_to{3.0 * to.x, 3.0 * to.y, to.yaw};
    ASSERT_NEAR(dubins_length(far_from, far_to, 6.0), 3.0 * length, 3e-9);
  }
}

TEST(Dubins, IsNeitherLongerNorShorterThanASearchOverFirstTurns) {
  RandomStream random(3, "dubins");
  for (int i = 0; i < 250; ++i) {
    const Pose2 from = test::random_pose(random, i % 2 == 0 ? 10.0 : 3.0);
    const Pose2 to = test::random_pose(random, i % 2 == 0 ? 10.0 : 3.0);
    ASSERT_NEAR(dubins_length(from, to, 2.0), test::DubinsOracle(from, to, 2.0).length(), 1e-7)
        << i << ": " << shortest_dubins(from, to, 2.0).word();
  }
}

TEST(Dubins, IsNeverLongerThanAConstructedCurve) {
  test::expect_never_longer_than_constructions(20000, "dubins", test::random_forward_construction,
                                               shortest_dubins, dubins_length);
}

// Walker's library answers 14.566 m to the first three and 15.708 m to the last.
TEST(Dubins, APureArcIsAPureArc) {
  for (const double side : {1.0, -1.0}) {
    expect_length({}, advance({}, side / 2.0, 2.0), 2.0, 2.0);
    expect_length({}, advance({}, side / 2.0, kPi), 2.0, kPi);
    expect_length({7.0, -3.0, 2.0}, advance({7.0, -3.0, 2.0}, side / 2.0, 2.0), 2.0, 2.0);
    expect_length({}, {2.0, side * 2.0, side * 0.5 * kPi}, 2.0, 3.1415926535897931);
  }
  EXPECT_EQ(shortest_dubins({}, advance({}, 0.5, 2.0), 2.0).word(), "L+");
}

TEST(Dubins, IdenticalPosesAreNothingApartInSpiteOfRounding) {
  expect_length({}, {}, 2.0, 0.0);
  for (const double yaw : {1e-12, -1e-12, 1e-16, -1e-16}) {
    expect_length({}, {0.0, 0.0, yaw}, 2.0, 0.0);
    expect_length({0.0, 0.0, kPi}, {0.0, 0.0, -kPi + yaw}, 2.0, 0.0);
    expect_length({5.0, 1.0, 0.7}, {5.0 + yaw, 1.0 - yaw, 0.7 + yaw}, 2.0, 0.0);
  }
}

TEST(Dubins, AStraightLineStaysStraightInSpiteOfRounding) {
  for (const double off : {0.0, 1e-12, -1e-12, 1e-16}) {
    expect_length({}, {10.0, off, -off}, 2.0, 10.0);
    expect_length({1.0, 1.0, 0.25 * kPi}, {6.0 + off, 6.0, 0.25 * kPi}, 2.0, std::sqrt(50.0));
  }
}

// pydubins PR 11: a full circle too much where the goal lies on the turning circle.
TEST(Dubins, AGoalOnATurningCircleTakesNoExtraCircle) {
  RandomStream random(4, "dubins");
  for (int i = 1; i < 48; ++i) {
    const double arc = 2.0 * kPi * i / 48.0;
    for (const double side : {1.0, -1.0}) {
      Pose2 to = advance({}, side / 2.0, 2.0 * arc);
      const Curve curve = shortest_dubins({}, to, 2.0);
      EXPECT_TRUE(test::obeys_the_laws(curve, {}, to, 2.0));
      EXPECT_LE(curve.length(), 2.0 * arc + 1e-9);
      to.x += random.uniform(-1e-11, 1e-11);
      to.y += random.uniform(-1e-11, 1e-11);
      to.yaw += random.uniform(-1e-11, 1e-11);
      EXPECT_LE(shortest_dubins({}, to, 2.0).length(), 2.0 * arc + 1e-9) << i;
      EXPECT_TRUE(test::obeys_the_laws(shortest_dubins({}, to, 2.0), {}, to, 2.0));
    }
  }
}

TEST(Dubins, AUTurnATrifleTooNarrowTakesThreeArcs) {
  expect_length({}, {0.0, 4.0, kPi}, 2.0, 2.0 * kPi);
  const double d = 4.0 - 1e-9;
  const double omega = 2.0 * (3.0 * kPi - 4.0 * std::asin((4.0 + d) / 8.0));
  EXPECT_NEAR(omega, 6.28331, 1e-5);
  expect_length({}, {0.0, d, kPi}, 2.0, omega, 1e-7);
  expect_length({}, {0.0, -d, kPi}, 2.0, omega, 1e-7);
}

// Turning on the spot, in units of the radius: a third of a half turn out, 5/3 back round, 1/3 in.
TEST(Dubins, TurnsOnTheSpotInThreeArcsTheMiddleOneBeyondHalfATurn) {
  expect_length({}, {0.0, 0.0, kPi}, 2.0, 2.0 * 7.0 * kPi / 3.0);
  const Curve curve = shortest_dubins({}, {0.0, 0.0, kPi}, 2.0);
  ASSERT_EQ(curve.count(), 3);
  EXPECT_NEAR(curve.begin()[1].length, 2.0 * 5.0 * kPi / 3.0, 1e-9);
}

TEST(Dubins, HoldsNoPieceOfRoundingAlone) {
  test::expect_no_piece_of_rounding(0.0, "rounding", shortest_dubins);
  test::expect_no_piece_of_rounding(100.0, "rounding", shortest_dubins);
  test::expect_no_piece_of_rounding(5000.0, "rounding", shortest_dubins);
}

TEST(Dubins, HoldsItsPromiseFarFromTheOrigin) {
  RandomStream random(5, "dubins");
  for (int i = 0; i < 20000; ++i) {
    const Pose2 from{random.uniform(-5000.0, 5000.0), random.uniform(-5000.0, 5000.0),
                     random.uniform(-20.0, 20.0)};
    const Curve known = test::random_forward_construction(random, 2.0);
    const Pose2 to = known.end_pose(from);
    const Curve found = shortest_dubins(from, to, 2.0);
    ASSERT_TRUE(test::obeys_the_laws(found, from, to, 2.0)) << i;
    ASSERT_LE(found.length(), known.length() + 1e-9) << i;
  }
}

// Lengths of (002)'s headland turns, rows 2.5 m apart, R = 3 m / tan(60 deg) and 3 m / tan(30 deg).
TEST(Dubins, HeadlandTurnsHaveTheLengthsOfPiAndOmega) {
  const double small = 3.0 / std::sqrt(3.0);
  const double large = 3.0 * std::sqrt(3.0);
  const double small_table[] = {9.14, 6.98, 9.48, 11.98, 14.48};
  const double large_table[] = {35.07, 31.64, 27.42, 20.37, 18.43};
  for (int d = 1; d <= 5; ++d) {
    const Pose2 to{2.5 * d, 0.0, -0.5 * kPi};
    EXPECT_NEAR(dubins_length({0.0, 0.0, 0.5 * kPi}, to, small), small_table[d - 1], 0.0051);
    EXPECT_NEAR(dubins_length({0.0, 0.0, 0.5 * kPi}, to, large), large_table[d - 1], 0.0051);
  }
  expect_length({0.0, 0.0, 0.5 * kPi}, {7.5, 0.0, -0.5 * kPi}, small, 7.5 + (kPi - 2.0) * small);
  const double omega = large * (3.0 * kPi - 4.0 * std::asin((2.0 * large + 5.0) / (4.0 * large)));
  expect_length({0.0, 0.0, 0.5 * kPi}, {5.0, 0.0, -0.5 * kPi}, large, omega);
}

}  // namespace
}  // namespace headland
