// SPDX-License-Identifier: Apache-2.0
#include "control/lookahead_rover/seed_lookahead_rover.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

const Point2 kP1(0.0, 0.0);
const Point2 kP2(10.0, 0.0);
constexpr double kCycle = 0.05;

SeedLookaheadConfig config_with_lookahead(double lookahead) {
  SeedLookaheadConfig config;
  config.lookahead_m = lookahead;
  config.crossed_within_m = lookahead;
  return config;
}

// (004) Fig. 10: the four situations of a circle and a segment.

TEST(LastCircleCrossing, IsNothingWhereTheCircleMissesTheLine) {  // a
  EXPECT_FALSE(last_circle_crossing({5.0, 2.0}, 1.0, kP1, kP2));
}

TEST(LastCircleCrossing, IsNothingWhereItCutsTheLineOutsideTheSegment) {  // b
  EXPECT_FALSE(last_circle_crossing({-3.0, 0.0}, 1.0, kP1, kP2));
  EXPECT_FALSE(last_circle_crossing({13.0, 0.5}, 1.0, kP1, kP2));
}

TEST(LastCircleCrossing, IsTheOnlyPointOnTheSegment) {  // c
  const auto ahead = last_circle_crossing({0.0, 0.0}, 2.0, kP1, kP2);
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(*ahead, 0.2, 1e-12);
  const auto behind = last_circle_crossing({10.0, 0.0}, 2.0, kP1, kP2);
  ASSERT_TRUE(behind);
  EXPECT_NEAR(*behind, 0.8, 1e-12);
}

TEST(LastCircleCrossing, IsThePointNearerToTheSecondWaypointOfTwo) {  // d
  const auto crossing = last_circle_crossing({5.0, 3.0}, 5.0, kP1, kP2);
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(*crossing, 0.9, 1e-12);
  const auto other_way = last_circle_crossing({5.0, 3.0}, 5.0, kP2, kP1);
  ASSERT_TRUE(other_way);
  EXPECT_NEAR(*other_way, 0.9, 1e-12);
}

TEST(LastCircleCrossing, IsNothingOnASegmentOfNoLength) {
  EXPECT_FALSE(last_circle_crossing({1.0, 0.0}, 1.0, kP1, kP1));
}

TEST(SeedLookaheadRover, AimsAtTheFirstSegmentTheCircleCrosses) {  // (004) Fig. 11
  // A narrow U: the circle crosses both legs, and the way forth counts.
  SeedLookaheadRover rover(config_with_lookahead(2.0),
                           {{0.0, 0.0}, {10.0, 0.0}, {10.0, 1.0}, {0.0, 1.0}});
  const auto step = rover.step({5.0, 0.0, 0.0}, kCycle);
  EXPECT_TRUE(step.goal_found);
  EXPECT_NEAR(step.goal.x(), 7.0, 1e-12);
  EXPECT_NEAR(step.goal.y(), 0.0, 1e-12);
}

TEST(SeedLookaheadRover, CrossesWaypointsWithinTheThresholdAndNeverGoesBack) {
  SeedLookaheadRover rover(config_with_lookahead(0.75),
                           {{0.0, 0.0}, {0.5, 0.0}, {1.0, 0.0}, {1.5, 0.0}, {9.0, 0.0}});
  rover.step({0.0, 0.0, 0.0}, kCycle);
  EXPECT_EQ(rover.current_index(), 1);
  rover.step({0.9, 0.0, 0.0}, kCycle);
  EXPECT_EQ(rover.current_index(), 3);
  rover.step({0.0, 0.0, 0.0}, kCycle);
  EXPECT_EQ(rover.current_index(), 3);
}

TEST(SeedLookaheadRover, IgnoresGoalPointsOnSegmentsAlreadyPassed) {
  SeedLookaheadRover rover(config_with_lookahead(1.0),
                           {{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {8.0, 4.0}});
  rover.step({3.5, 0.0, 0.0}, kCycle);
  ASSERT_EQ(rover.current_index(), 1);
  const auto step = rover.step({3.5, 0.0, 0.0}, kCycle);
  EXPECT_NEAR(step.goal.x(), 4.0, 1e-12);  // not (2.5, 0) or (4.5, 0), on the first segment's line
  EXPECT_GT(step.goal.y(), 0.0);
}

TEST(SeedLookaheadRover, FallsBackToTheLastWaypointCrossed) {
  SeedLookaheadRover rover(config_with_lookahead(0.75), {{0.0, 0.0}, {5.0, 0.0}, {10.0, 0.0}});
  rover.step({4.9, 0.0, 0.0}, kCycle);
  const auto step = rover.step({5.0, 3.0, 0.0}, kCycle);
  EXPECT_FALSE(step.goal_found);
  EXPECT_EQ(step.goal, Point2(5.0, 0.0));
  EXPECT_NEAR(step.steering, -0.5 * kPi, 1e-12);
}

TEST(SeedLookaheadRover, TurnsByTheWholeSteeringAngleInOneCycle) {  // (004) Eqs. 5-7
  SeedLookaheadConfig config = config_with_lookahead(1.0);
  config.speed_mps = 2.0;
  SeedLookaheadRover rover(config, {{0.0, 0.0}, {0.0, 10.0}});
  const auto step = rover.step({0.0, 0.0, deg_to_rad(45.0)}, kCycle);
  EXPECT_NEAR(step.steering, deg_to_rad(45.0), 1e-12);
  EXPECT_NEAR(step.yaw_rate, deg_to_rad(45.0) / kCycle, 1e-9);
  EXPECT_NEAR(step.speed, 2.0 * (1.0 - 45.0 / 360.0), 1e-12);
  const auto mirrored = rover.step({0.0, 0.0, deg_to_rad(135.0)}, kCycle);
  EXPECT_NEAR(mirrored.speed, step.speed, 1e-12);
}

TEST(SeedLookaheadRover, TakesTheShorterWayRoundAcrossTheWrap) {
  SeedLookaheadRover rover(config_with_lookahead(1.0), {{0.0, 0.0}, {-10.0, 0.0}});
  const auto step = rover.step({0.0, 0.1, deg_to_rad(-170.0)}, kCycle);
  EXPECT_LT(std::abs(step.steering), deg_to_rad(20.0));
}

TEST(SeedLookaheadRover, LeavesAnglesBelowTheThresholdUncorrected) {  // (004) Table 3
  SeedLookaheadConfig config = config_with_lookahead(1.0);
  config.steering_threshold_deg = 2.5;
  SeedLookaheadRover rover(config, {{0.0, 0.0}, {10.0, 0.0}});
  const auto below = rover.step({0.0, 0.0, deg_to_rad(2.4)}, kCycle);
  EXPECT_EQ(below.yaw_rate, 0.0);
  EXPECT_EQ(below.speed, config.speed_mps);
  const auto above = rover.step({0.0, 0.0, deg_to_rad(2.6)}, kCycle);
  EXPECT_LT(above.yaw_rate, 0.0);
}

TEST(SeedLookaheadRover, StopsOnceTheLastWaypointIsCrossed) {
  SeedLookaheadRover rover(config_with_lookahead(0.75), {{0.0, 0.0}, {1.0, 0.0}});
  EXPECT_FALSE(rover.step({0.0, 0.0, 0.0}, kCycle).done);
  const auto step = rover.step({0.5, 0.0, 0.0}, kCycle);
  EXPECT_TRUE(step.done);
  EXPECT_EQ(step.speed, 0.0);
  EXPECT_EQ(step.yaw_rate, 0.0);
}

TEST(SeedLookaheadRover, ReachesItsGoalPointBehindWhenTheThresholdIsBelowTheLookahead) {
  // Why D_th equals LD: with waypoints farther apart than LD and D_th below it, the first segment
  // the circle crosses is the one behind the rover.
  SeedLookaheadConfig config = config_with_lookahead(0.75);
  config.crossed_within_m = 0.2;
  SeedLookaheadRover rover(config, {{0.0, 0.0}, {1.65, 0.0}, {3.3, 0.0}});
  rover.step({1.5, 0.0, 0.0}, kCycle);
  const auto step = rover.step({1.4, 0.0, 0.0}, kCycle);
  EXPECT_TRUE(step.goal_found);
  SeedLookaheadRover lagging(config, {{0.0, 0.0}, {1.65, 0.0}, {3.3, 0.0}});
  const auto behind = lagging.step({1.2, 0.0, 0.0}, kCycle);
  EXPECT_LT(behind.goal.x(), 1.2);
  SeedLookaheadRover published(config_with_lookahead(0.75), {{0.0, 0.0}, {1.65, 0.0}, {3.3, 0.0}});
  EXPECT_GT(published.step({1.2, 0.0, 0.0}, kCycle).goal.x(), 1.2);
}

TEST(TurnThenMove, DrivesStraightAlongTheNewHeading) {
  const Pose2 pose = turn_then_move({1.0, 2.0, 0.0}, 2.0, 0.5 * kPi / kCycle, kCycle);
  EXPECT_NEAR(pose.x, 1.0, 1e-12);
  EXPECT_NEAR(pose.y, 2.1, 1e-12);
  EXPECT_NEAR(pose.yaw, 0.5 * kPi, 1e-12);
}

}  // namespace
}  // namespace headland
