// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/fishtail.hpp"

#include <gtest/gtest.h>

#include "core/geometry/dubins.hpp"
#include "tests/support/steering_curves.hpp"

namespace headland {
namespace {

constexpr Pose2 kUpTheRow{0.0, 0.0, 0.5 * kPi};

TEST(Fishtail, BetweenRowsIsTwoQuarterCirclesAndAStraightInReverse) {
  for (const double side : {1.0, -1.0}) {
    const Pose2 to{side * 2.5, 0.0, -0.5 * kPi};
    const auto turn = fishtail(kUpTheRow, to, 3.0);
    ASSERT_TRUE(turn);
    EXPECT_EQ(turn->word(), side > 0.0 ? "R+S-R+" : "L+S-L+");
    EXPECT_TRUE(test::obeys_the_laws(*turn, kUpTheRow, to, 3.0));
    EXPECT_EQ(turn->cusps(), 2);
    EXPECT_NEAR(turn->begin()[0].length, 0.5 * kPi * 3.0, 1e-12);
    EXPECT_NEAR(turn->begin()[1].length, -(6.0 - 2.5), 1e-12);
    EXPECT_NEAR(turn->length(), (kPi + 2.0) * 3.0 - 2.5, 1e-12);
  }
}

// Rows of (002), 2.5 m apart, R = 3 m / tan(60 deg) and 3 m / tan(30 deg).
TEST(Fishtail, HeadlandTurnsHaveTheirTabulatedLengths) {
  const auto length = [](int d, double radius) {
    return fishtail(kUpTheRow, {2.5 * d, 0.0, -0.5 * kPi}, radius).value().length();
  };
  EXPECT_NEAR(length(1, std::sqrt(3.0)), 6.41, 0.0051);
  const double table[] = {24.22, 21.72, 19.22, 16.72};
  for (int d = 1; d <= 4; ++d) {
    EXPECT_NEAR(length(d, 3.0 * std::sqrt(3.0)), table[d - 1], 0.0051);
  }
}

TEST(Fishtail, RowsWiderApartThanTheTurningCircleAreReachedByBackingOutwardsAlone) {
  for (const double d : {6.0, 6.1, 9.0}) {
    const Pose2 to{d, 0.0, -0.5 * kPi};
    const auto turn = fishtail(kUpTheRow, to, 3.0);
    ASSERT_TRUE(turn);
    EXPECT_EQ(turn->word(), "L+S-L+") << "away from the next row, and back over to it";
    EXPECT_TRUE(test::obeys_the_laws(*turn, kUpTheRow, to, 3.0));
    EXPECT_NEAR(turn->length(), (kPi + 2.0) * 3.0 + d, 1e-9);
    EXPECT_GT(turn->length(), dubins_length(kUpTheRow, to, 3.0));
  }
}

TEST(Fishtail, IsNoneWhereTheStraightWouldGoForwards) {
  EXPECT_FALSE(fishtail({}, {10.0, 0.0, 0.0}, 3.0));
  EXPECT_FALSE(fishtail({}, {}, 3.0));
}

TEST(Fishtail, SkewedAndShiftedRowEndsAreReachedWithArcsOfOtherAngles) {
  for (const double skew : {-0.6, -0.2, 0.3, 0.7}) {
    for (const double side : {1.0, -1.0}) {
      const Pose2 to{side * 2.5, side * 2.5 * std::tan(skew), -0.5 * kPi + 0.2 * skew};
      const auto turn = fishtail(kUpTheRow, to, 4.0);
      ASSERT_TRUE(turn) << skew;
      EXPECT_TRUE(test::obeys_the_laws(*turn, kUpTheRow, to, 4.0)) << skew;
      EXPECT_EQ(turn->word(), side > 0.0 ? "R+S-R+" : "L+S-L+");
    }
  }
}

TEST(Fishtail, ObeysTheLawsWhereverItExists) {
  RandomStream random(1, "fishtail");
  int found = 0;
  for (int i = 0; i < 20000; ++i) {
    const Pose2 from = test::random_pose(random, 5.0);
    const Pose2 to = test::random_pose(random, 5.0);
    const auto turn = fishtail(from, to, 2.0);
    const auto mirror_image = fishtail(test::mirrored(from), test::mirrored(to), 2.0);
    ASSERT_EQ(turn.has_value(), mirror_image.has_value());
    if (!turn) continue;
    ++found;
    ASSERT_TRUE(test::obeys_the_laws(*turn, from, to, 2.0)) << i;
    ASSERT_NEAR(turn->length(), mirror_image->length(), 1e-9);
    for (const CurvePiece& piece : *turn) {
      ASSERT_EQ(piece.length < 0.0, piece.curvature == 0.0) << "only the straight is in reverse";
    }
  }
  EXPECT_GT(found, 2000);
}

TEST(Fishtail, BeginsAndEndsWithStraightWheelsWhereTheSteeringAsksForIt) {
  RandomStream random(3, "fishtail");
  int found = 0;
  for (const double sharpness : {0.1, 0.5, 5.0}) {
    const SmoothTurn smooth({0.5, sharpness});
    for (int i = 0; i < 10000; ++i) {
      const Pose2 from = test::random_pose(random, 5.0);
      const Pose2 to = test::random_pose(random, 5.0);
      const auto turn = fishtail(from, to, smooth);
      if (!turn) continue;
      ++found;
      ASSERT_TRUE(test::obeys_the_smooth_laws(*turn, from, to, smooth)) << i;
      ASSERT_EQ(turn->cusps(), 2);
    }
  }
  EXPECT_GT(found, 2000);
}

TEST(Fishtail, FindsEveryConstructedFishtailOfLessThanACircle) {
  RandomStream random(2, "fishtail");
  for (int i = 0; i < 20000; ++i) {
    const double side = random.index(2) == 0 ? 1.0 : -1.0;
    const double first = random.uniform(0.0, kPi);
    const double last = random.uniform(0.0, kPi);
    Curve known;
    known.add({side / 2.0, 2.0 * first});
    known.add({0.0, -random.uniform(0.01, 10.0)});
    known.add({side / 2.0, 2.0 * last});
    const Pose2 from = test::random_pose(random, 50.0);
    const auto found = fishtail(from, known.end_pose(from), 2.0);
    ASSERT_TRUE(found) << i;
    ASSERT_LE(found->length(), known.length() + 1e-9) << i;
  }
}

}  // namespace
}  // namespace headland
