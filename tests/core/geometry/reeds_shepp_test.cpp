// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/reeds_shepp.hpp"

#include <gtest/gtest.h>

#include "core/geometry/dubins.hpp"
#include "core/geometry/fishtail.hpp"
#include "tests/support/steering_curves.hpp"

namespace headland {
namespace {

void expect_length(const Pose2& from, const Pose2& to, double radius, double length) {
  const Curve curve = shortest_reeds_shepp(from, to, radius);
  EXPECT_TRUE(test::obeys_the_laws(curve, from, to, radius));
  EXPECT_NEAR(curve.length(), length, 1e-9) << curve.word();
  EXPECT_NEAR(reeds_shepp_length(from, to, radius), length, 1e-9);
}

TEST(ReedsShepp, ObeysTheLawsOfSteeringCurves) {
  RandomStream random(1, "reeds_shepp");
  for (int i = 0; i < 20000; ++i) {
    const double half_side = i % 2 == 0 ? 10.0 : 2.0;
    const Pose2 from = test::random_pose(random, half_side);
    const Pose2 to = test::random_pose(random, half_side);
    const double radius = random.uniform(0.2, 8.0);
    const Curve curve = shortest_reeds_shepp(from, to, radius);
    ASSERT_TRUE(test::obeys_the_laws(curve, from, to, radius)) << i;
    ASSERT_LE(curve.cusps(), 2) << "a shortest curve needs no more";
    ASSERT_NEAR(reeds_shepp_length(from, to, radius), curve.length(), 1e-10);
  }
}

TEST(ReedsShepp, LengthIsAMetricWithTheSymmetriesOfTheProblem) {
  RandomStream random(2, "reeds_shepp");
  for (int i = 0; i < 20000; ++i) {
    const Pose2 a = test::random_pose(random, 5.0);
    const Pose2 b = test::random_pose(random, 5.0);
    const Pose2 c = test::random_pose(random, 5.0);
    const double length = reeds_shepp_length(a, b, 2.0);
    ASSERT_NEAR(reeds_shepp_length(b, a, 2.0), length, 1e-9);
    ASSERT_NEAR(reeds_shepp_length(reversed(a), reversed(b), 2.0), length, 1e-9);
    ASSERT_NEAR(reeds_shepp_length(test::mirrored(a), test::mirrored(b), 2.0), length, 1e-9);
    ASSERT_LE(length, reeds_shepp_length(a, c, 2.0) + reeds_shepp_length(c, b, 2.0) + 1e-9) << i;
  }
}

TEST(ReedsShepp, IsNoLongerThanDubinsEitherWayOrAFishtail) {
  RandomStream random(3, "reeds_shepp");
  for (int i = 0; i < 20000; ++i) {
    const Pose2 from = test::random_pose(random, 5.0);
    const Pose2 to = test::random_pose(random, 5.0);
    const double length = reeds_shepp_length(from, to, 2.0);
    ASSERT_LE(length, dubins_length(from, to, 2.0) + 1e-9) << i;
    ASSERT_LE(length, dubins_length(to, from, 2.0) + 1e-9) << i;
    const auto turn = fishtail(from, to, 2.0);
    ASSERT_LE(length, turn ? turn->length() + 1e-9 : length) << i;
  }
}

TEST(ReedsShepp, IsNeverLongerThanAConstructedCurve) {
  test::expect_never_longer_than_constructions(20000, "reeds_shepp",
                                               test::random_reversing_construction,
                                               shortest_reeds_shepp, reeds_shepp_length);
}

TEST(ReedsShepp, APureArcIsAPureArcInBothGears) {
  for (const double side : {1.0, -1.0}) {
    for (const double gear : {1.0, -1.0}) {
      expect_length({}, advance({}, side / 2.0, gear * 2.0), 2.0, 2.0);
      expect_length({}, advance({}, side / 2.0, gear * kPi), 2.0, kPi);
      expect_length({}, {gear * 8.0, 0.0, 0.0}, 2.0, 8.0);
    }
  }
  EXPECT_EQ(shortest_reeds_shepp({}, advance({}, -0.5, -2.0), 2.0).word(), "R-");
  EXPECT_EQ(shortest_reeds_shepp({}, {-8.0, 0.0, 0.0}, 2.0).word(), "S-");
}

TEST(ReedsShepp, IdenticalPosesAreNothingApartInSpiteOfRounding) {
  expect_length({}, {}, 2.0, 0.0);
  for (const double yaw : {1e-12, -1e-12, 1e-16, -1e-16}) {
    EXPECT_NEAR(reeds_shepp_length({}, {0.0, 0.0, yaw}, 2.0), 0.0, 1e-9);
    EXPECT_NEAR(reeds_shepp_length({0.0, 0.0, kPi}, {0.0, 0.0, -kPi + yaw}, 2.0), 0.0, 1e-9);
  }
}

TEST(ReedsShepp, GoalsATrifleOffAWordsBorderAreReachedAllTheSame) {
  RandomStream random(4, "reeds_shepp");
  for (int i = 0; i < 20000; ++i) {
    const Curve known = test::random_reversing_construction(random, 2.0);
    const double off = std::pow(10.0, random.uniform(-16.0, -6.0));
    Pose2 to = known.end_pose({});
    to.x += random.uniform(-off, off);
    to.y += random.uniform(-off, off);
    to.yaw += random.uniform(-off, off);
    const Curve found = shortest_reeds_shepp({}, to, 2.0);
    ASSERT_TRUE(test::obeys_the_laws(found, {}, to, 2.0)) << i << " off by " << off;
    ASSERT_LE(found.cusps(), 2) << i << " off by " << off;
  }
}

// Two poses of which only the last digits differ, as at a projected map's large coordinates, are
// not a manoeuvre of cusps apart where one arc or two do.
TEST(ReedsShepp, IsNoLongerThanDubinsForGoalsATrifleOffALattice) {
  RandomStream random(7, "reeds_shepp");
  for (int i = 0; i < 100000; ++i) {
    const double off = std::pow(10.0, random.uniform(-16.0, -8.0));
    const Pose2 from{0.0, 0.0, 0.25 * kPi * random.index(8)};
    const Pose2 to{0.5 * (random.index(5) - 2) + random.uniform(-off, off),
                   0.5 * (random.index(5) - 2) + random.uniform(-off, off),
                   0.25 * kPi * random.index(8) + random.uniform(-off, off)};
    ASSERT_LE(reeds_shepp_length(from, to, 1.0), dubins_length(from, to, 1.0) + 1e-9)
        << i << " off by " << off;
  }
}

TEST(ReedsShepp, IdenticalPosesAreNothingApartAtLargeCoordinates) {
  RandomStream random(8, "reeds_shepp");
  for (int i = 0; i < 1000; ++i) {
    const Pose2 from{random.uniform(499000.0, 501000.0), 4.6e6, random.uniform(-kPi, kPi)};
    const Pose2 to{from.x + random.uniform(-2e-10, 2e-10), from.y, from.yaw + 4.0 * kPi};
    EXPECT_LE(reeds_shepp_length(from, to, 3.0), 1e-9) << i;
    EXPECT_EQ(shortest_reeds_shepp(from, to, 3.0).cusps(), 0) << i;
  }
}

// A piece that is rounding alone would be a change of gear to whoever drives the curve.
TEST(ReedsShepp, RoundingPutsNoCuspIntoAForwardCurve) {
  RandomStream random(5, "reeds_shepp");
  for (int i = 0; i < 20000; ++i) {
    const Pose2 from = test::random_pose(random, 50.0);
    const double first = random.uniform(0.0, 1.5);
    const double last = random.uniform(0.0, 1.5);
    Curve known;
    known.add({random.index(2) == 0 ? 0.5 : -0.5, 2.0 * first * random.index(2)});
    known.add({0.0, 6.0 + random.uniform(0.0, 10.0)});
    known.add({random.index(2) == 0 ? 0.5 : -0.5, 2.0 * last * random.index(2)});
    const Curve found = shortest_reeds_shepp(from, known.end_pose(from), 2.0);
    if (found.length() < known.length() - 1e-9) continue;  // reversing is a true gain
    for (const CurvePiece& piece : found) ASSERT_GT(piece.length, 0.0) << i << found.word();
  }
}

TEST(ReedsShepp, HoldsNoPieceOfRoundingAlone) {
  test::expect_no_piece_of_rounding(0.0, "rounding", shortest_reeds_shepp);
  test::expect_no_piece_of_rounding(100.0, "rounding", shortest_reeds_shepp);
  test::expect_no_piece_of_rounding(5000.0, "rounding", shortest_reeds_shepp);
}

TEST(ReedsShepp, HoldsItsPromiseFarFromTheOrigin) {
  RandomStream random(6, "reeds_shepp");
  for (int i = 0; i < 20000; ++i) {
    Pose2 from = test::random_pose(random, 5000.0);
    from.yaw *= 6.0;
    const Curve known = test::random_reversing_construction(random, 2.0);
    const Pose2 to = known.end_pose(from);
    const Curve found = shortest_reeds_shepp(from, to, 2.0);
    ASSERT_TRUE(test::obeys_the_laws(found, from, to, 2.0)) << i;
    ASSERT_LE(found.length(), known.length() + 1e-9) << i;
  }
}

// A nearly parallel shift by h costs about sqrt(8 h R): the metric is not smooth, but continuous.
TEST(ReedsShepp, ASmallShiftSidewaysCostsASmallManoeuvre) {
  for (const double shift : {1e-2, 1e-4, 1e-6}) {
    const Curve curve = shortest_reeds_shepp({}, {0.0, shift, 0.0}, 2.0);
    EXPECT_TRUE(test::obeys_the_laws(curve, {}, {0.0, shift, 0.0}, 2.0));
    EXPECT_LE(curve.length(), 3.0 * std::sqrt(8.0 * shift * 2.0));
    EXPECT_GE(curve.length(), shift);
  }
}

// (002)'s headland turns, rows 2.5 m apart: half a circle's length in three arcs for d W <= 2 R.
TEST(ReedsShepp, HeadlandTurnsNarrowerThanTheTurningCircleCostPiR) {
  const Pose2 from{0.0, 0.0, 0.5 * kPi};
  const double small = 3.0 / std::sqrt(3.0);
  const double large = 3.0 * std::sqrt(3.0);
  expect_length(from, {2.5, 0.0, -0.5 * kPi}, small, kPi * small);
  for (int d = 1; d <= 4; ++d) {
    expect_length(from, {2.5 * d, 0.0, -0.5 * kPi}, large, kPi * large);
    expect_length(from, {-2.5 * d, 0.0, -0.5 * kPi}, large, kPi * large);
  }
  EXPECT_NEAR(kPi * small, 5.44, 0.005);
  EXPECT_NEAR(kPi * large, 16.32, 0.005);
}

}  // namespace
}  // namespace headland
