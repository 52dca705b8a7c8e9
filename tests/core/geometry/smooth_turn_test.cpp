// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/smooth_turn.hpp"

#include "tests/support/steering_curves.hpp"

namespace headland {
namespace {

const SteeringLimits kSharp{0.5, 0.5};
const SteeringLimits kGentle{0.5, 0.05};

TEST(SmoothTurn, EndsOnItsChordInTheDirectionOfHalfTheAngle) {
  for (const SteeringLimits& limits : {kSharp, kGentle, SteeringLimits{0.3, 100.0}}) {
    const SmoothTurn turn(limits);
    for (double angle = 0.01; angle < 6.28; angle += 0.03) {
      for (const double hand : {1.0, -1.0}) {
        Curve curve;
        turn.append(curve, angle, hand, 1e-13);
        const SmoothTurn::Shape shape = turn.shape(angle);
        const double chord = turn.radius() * shape.chord;
        const Pose2 to{chord * shape.cosine, hand * chord * shape.sine, hand * angle};
        ASSERT_TRUE(test::obeys_the_smooth_laws(curve, {}, to, turn)) << angle;
        ASSERT_NEAR(curve.length(), turn.radius() * turn.length(angle), 1e-12);
        ASSERT_EQ(curve.count(), angle > turn.least_with_arc() ? 3 : 2);
      }
    }
  }
}

TEST(SmoothTurn, SlopesAreThoseOfTheChord) {
  for (const SteeringLimits& limits : {kSharp, kGentle}) {
    const SmoothTurn turn(limits);
    for (double angle = 0.05; angle < 6.2; angle += 0.1) {
      constexpr double kStep = 1e-6;
      const double slope =
          (turn.shape(angle + kStep).chord - turn.shape(angle - kStep).chord) / (2.0 * kStep);
      ASSERT_NEAR(turn.shape(angle).slope, slope, 1e-7) << angle;
    }
  }
}

TEST(SmoothTurn, IsContinuousWhereTheArcVanishes) {
  const SmoothTurn turn(kSharp);
  const double angle = turn.least_with_arc();
  EXPECT_NEAR(turn.shape(angle).chord, turn.shape(angle - 1e-12).chord, 1e-11);
  EXPECT_NEAR(turn.length(angle), turn.length(angle - 1e-12), 1e-11);
}

TEST(SmoothTurn, WithoutALimitToSharpnessIsAnArc) {
  const SmoothTurn turn({0.5});
  EXPECT_FALSE(turn.has_ramps());
  EXPECT_EQ(turn.ahead(), 0.0);
  EXPECT_EQ(turn.aside(), 1.0);
  Curve curve;
  turn.append(curve, 1.0, -1.0, 1e-13);
  ASSERT_EQ(curve.count(), 1);
  EXPECT_EQ(curve.word(), "R+");
  EXPECT_NEAR(curve.length(), 2.0, 1e-15);
}

TEST(SmoothTurn, ATurnOfNothingIsAStraight) {
  const SmoothTurn turn(kSharp);
  Curve curve;
  turn.append(curve, 1e-14, 1.0, 1e-12);
  EXPECT_EQ(curve.word(), "S+");
  EXPECT_EQ(turn.length(0.0), 0.0);
  EXPECT_EQ(turn.shape(0.0).chord, 0.0);
}

}  // namespace
}  // namespace headland
