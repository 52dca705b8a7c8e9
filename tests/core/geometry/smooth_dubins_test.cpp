// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/smooth_dubins.hpp"

#include <algorithm>

#include "core/geometry/dubins.hpp"
#include "tests/support/steering_curves.hpp"

namespace headland {
namespace {

constexpr double kRadius = 2.0;
// From steering as quick as a rover's to one that needs more than half a turn to its limit.
constexpr double kSharpnesses[] = {0.05, 0.1, 0.2, 0.5, 2.0, 50.0};

SmoothTurn sharp(double sharpness) { return SmoothTurn({1.0 / kRadius, sharpness}); }

// A turn, two, or two about a straight.
Curve construction(RandomStream& random, const SmoothTurn& turn) {
  const auto angle = [&] {
    const double most = random.index(2) == 0 ? std::min(turn.least_with_arc(), 6.0) : 6.0;
    return random.uniform(0.0, most);
  };
  const double hand = random.index(2) == 0 ? 1.0 : -1.0;
  const int kind = random.index(5);
  Curve curve;
  if (kind == 0) curve.add({0.0, random.uniform(0.0, 10.0)});
  turn.append(curve, angle(), hand, 1e-12);
  if (kind >= 2) curve.add({0.0, random.uniform(0.0, 10.0)});
  if (kind >= 3) turn.append(curve, angle(), kind == 3 ? hand : -hand, 1e-12);
  return curve;
}

TEST(SmoothDubins, ObeysTheLawsOfSmoothCurvesAndOfMirrorImages) {
  for (const double sharpness : kSharpnesses) {
    const SmoothTurn turn = sharp(sharpness);
    RandomStream random(1, "smooth");
    for (int i = 0; i < 5000; ++i) {
      const Pose2 from = test::random_pose(random, i % 2 == 0 ? 10.0 : 3.0);
      const Pose2 to = test::random_pose(random, i % 2 == 0 ? 10.0 : 3.0);
      const Curve curve = smooth_dubins(from, to, turn);
      ASSERT_TRUE(test::obeys_the_smooth_laws(curve, from, to, turn)) << sharpness << " " << i;
      ASSERT_EQ(curve.cusps(), 0);
      ASSERT_NEAR(smooth_dubins_length(from, to, turn), curve.length(), 1e-9);
      ASSERT_GE(curve.length(), dubins_length(from, to, kRadius) - 1e-9);
      const Curve image = smooth_dubins(test::mirrored(from), test::mirrored(to), turn);
      ASSERT_NEAR(image.length(), curve.length(), 1e-9) << sharpness << " " << i;
    }
  }
}

TEST(SmoothDubins, IsNeverLongerThanAConstructedCurve) {
  for (const double sharpness : {0.2, 0.5, 2.0, 50.0}) {
    const SmoothTurn turn = sharp(sharpness);
    RandomStream random(2, "smooth");
    for (int i = 0; i < 10000; ++i) {
      const Pose2 from = test::random_pose(random, 50.0);
      const Curve known = construction(random, turn);
      const Pose2 to = known.end_pose(from);
      const Curve found = smooth_dubins(from, to, turn);
      ASSERT_TRUE(test::obeys_the_smooth_laws(found, from, to, turn)) << sharpness << " " << i;
      ASSERT_LE(found.length(), known.length() + 1e-6)
          << sharpness << " " << i << " " << known.word() << " " << found.word();
    }
  }
}

TEST(SmoothDubins, ComesToDubinsAsTheSteeringGetsQuicker) {
  RandomStream random(3, "smooth");
  double least_excess = 1.0;
  for (const double sharpness : {2.0, 200.0, 2e4, 2e6}) {
    const SmoothTurn turn = sharp(sharpness);
    double sum = 0.0;
    double dubins = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const Pose2 from = test::random_pose(random, 10.0);
      const Pose2 to = test::random_pose(random, 10.0);
      sum += smooth_dubins_length(from, to, turn);
      dubins += dubins_length(from, to, kRadius);
    }
    EXPECT_LT(sum / dubins - 1.0, least_excess) << sharpness;
    least_excess = 0.2 * (sum / dubins - 1.0) + 1e-7;
  }
  EXPECT_LT(least_excess, 1e-5);
}

TEST(SmoothDubins, IsDubinsWhereSharpnessHasNoLimit) {
  RandomStream random(4, "smooth");
  for (int i = 0; i < 1000; ++i) {
    const Pose2 from = test::random_pose(random, 10.0);
    const Pose2 to = test::random_pose(random, 10.0);
    const Curve curve = smooth_dubins(from, to, SmoothTurn({1.0 / kRadius}));
    ASSERT_EQ(curve.word(), shortest_dubins(from, to, kRadius).word());
  }
}

TEST(SmoothDubins, TheSamePoseIsNothingApartAndAStraightIsAStraight) {
  const SmoothTurn turn = sharp(0.5);
  for (const double off : {0.0, 1e-12, -1e-12}) {
    EXPECT_NEAR(smooth_dubins({}, {0.0, 0.0, off}, turn).length(), 0.0, 1e-5);
    const Pose2 to{10.0, off, -off};
    EXPECT_TRUE(test::obeys_the_smooth_laws(smooth_dubins({}, to, turn), {}, to, turn));
    EXPECT_NEAR(smooth_dubins({}, to, turn).length(), 10.0, 1e-9);
    EXPECT_EQ(smooth_dubins({}, to, turn).word().find_first_not_of("S+"), std::string::npos);
  }
}

// A little to the side is reached by a little to both sides, without the turns of whole circles.
TEST(SmoothDubins, SmallDeflectionsStaySmall) {
  const SmoothTurn turn = sharp(0.2);
  for (const double y : {1e-6, 1e-3, 0.05, -0.2}) {
    for (const double x : {4.0, 6.0, 20.0}) {
      const Curve curve = smooth_dubins({}, {x, y, 0.0}, turn);
      ASSERT_TRUE(test::obeys_the_smooth_laws(curve, {}, {x, y, 0.0}, turn));
      EXPECT_LT(curve.length(), x + std::abs(y));
    }
  }
}

// Between the width of the narrowest turn and that of two turns there is no room for a straight:
// others turn right round there.
TEST(SmoothDubins, TurnsBetweenRowsNeverTurnRightRound) {
  for (const double sharpness : {0.15, 0.261, 0.76}) {
    const SmoothTurn turn({1.0 / 3.2, sharpness});
    for (double apart = 6.6; apart < 14.0; apart += 0.05) {
      for (const double side : {1.0, -1.0}) {
        const Pose2 to{0.0, side * apart, kPi};
        const Curve curve = smooth_dubins({}, to, turn);
        ASSERT_TRUE(test::obeys_the_smooth_laws(curve, {}, to, turn)) << apart;
        EXPECT_LT(curve.length(), dubins_length({}, to, 3.2) + 3.6) << curve.word();
      }
    }
  }
}

TEST(SmoothDubins, HoldsItsPromiseFarFromTheOrigin) {
  RandomStream random(5, "smooth");
  const SmoothTurn turn = sharp(0.5);
  for (int i = 0; i < 10000; ++i) {
    const Pose2 from{random.uniform(-5000.0, 5000.0), random.uniform(-5000.0, 5000.0),
                     random.uniform(-20.0, 20.0)};
    const Pose2 to = construction(random, turn).end_pose(from);
    ASSERT_TRUE(test::obeys_the_smooth_laws(smooth_dubins(from, to, turn), from, to, turn)) << i;
  }
}

}  // namespace
}  // namespace headland
