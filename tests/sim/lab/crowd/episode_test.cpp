// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/crowd/episode.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

// Drives straight on, whatever there is.
class StraightRobot : public EpisodeRobot {
 public:
  StraightRobot(const Point2& start, const Point2& velocity) : at_(start), velocity_(velocity) {}
  Point2 position() const override { return at_; }
  Point2 velocity() const override { return velocity_; }
  void decide(double, std::span<const Agent> agents) override {
    for (const Agent& agent : agents) EXPECT_EQ(agent.radius_m, 0.3);
  }
  void move(double, double dt) override { at_ += dt * velocity_; }

 private:
  Point2 at_;
  Point2 velocity_;
};

// Ticks by a millisecond whenever it is read.
class CountingClock : public Clock {
 public:
  double now() const override { return 0.001 * static_cast<double>(++calls_); }

 private:
  mutable int calls_ = 0;
};

CrowdOutcome drive(const CrowdScenario& scenario, bool visible, EpisodeRobot& robot) {
  std::vector<double> plan_ms;
  const CrowdOutcome outcome =
      run_crowd_episode(scenario, visible, robot, CountingClock(), plan_ms);
  EXPECT_EQ(static_cast<double>(plan_ms.size()), outcome.time_s / 0.25);
  for (const double time : plan_ms) EXPECT_NEAR(time, 1.0, 1e-9);
  return outcome;
}

// Someone who stays where he is.
CrowdWalk standing(double x, double y) { return {{x, y}, {x, y}}; }

const CrowdWalk kEastwards = {{-7.5, 0.0}, {7.5, 0.0}};

TEST(CrowdEpisode, AloneTheRobotIsThereAfterTheFirstStepInItsGoal) {
  StraightRobot robot(kEastwards.start, {1.0, 0.0});
  const CrowdOutcome outcome = drive({kEastwards, {}}, true, robot);
  EXPECT_EQ(outcome.success_count, 1.0);
  EXPECT_EQ(outcome.collision_count, 0.0);
  EXPECT_EQ(outcome.time_s, 14.5);  // 14.4 m to a goal of 0.6 m, in steps of 0.25 s
  EXPECT_NEAR(outcome.length_m, 14.5, 1e-9);
  EXPECT_EQ(outcome.people_count, 0.0);
  EXPECT_EQ(outcome.seen_count, 0.0);
}

TEST(CrowdEpisode, EndsAtTheTimeoutWhereTheGoalIsNotReached) {
  StraightRobot robot(kEastwards.start, {0.5, 0.0});
  const CrowdOutcome outcome = drive({kEastwards, {}}, true, robot);
  EXPECT_EQ(outcome.success_count + outcome.collision_count, 0.0);
  EXPECT_EQ(outcome.time_s, 24.0);
  EXPECT_NEAR(outcome.length_m, 12.0, 1e-9);
}

TEST(CrowdEpisode, OfARobotThatDrivesIntoSomeoneIsACollision) {
  StraightRobot robot(kEastwards.start, {1.0, 0.0});
  const CrowdOutcome outcome = drive({kEastwards, {standing(0.0, 0.1)}}, false, robot);
  EXPECT_EQ(outcome.collision_count, 1.0);
  EXPECT_EQ(outcome.success_count, 0.0);
  EXPECT_EQ(outcome.fault_count, 1.0);
  EXPECT_EQ(outcome.time_s, 7.0);  // it touches 0.59 m before 7.5 m
  EXPECT_LT(outcome.gap_m, 0.0);
}

TEST(CrowdEpisode, OfARobotThatStandsIsNotItsFault) {
  StraightRobot robot({0.0, 0.0}, {0.0, 0.0});
  const CrowdOutcome outcome =
      drive({{{0.0, 0.0}, {7.5, 0.0}}, {{{-3.0, 0.1}, {3.0, 0.1}}}}, false, robot);
  EXPECT_EQ(outcome.collision_count, 1.0);
  EXPECT_EQ(outcome.fault_count, 0.0);
}

// 3 m in a step: neither end of the step is near anyone.
TEST(CrowdEpisode, FindsTheCollisionBetweenTwoSteps) {
  StraightRobot robot(kEastwards.start, {12.0, 0.0});
  const CrowdOutcome outcome = drive({kEastwards, {standing(-3.0, 0.55)}}, false, robot);
  EXPECT_EQ(outcome.collision_count, 1.0);
  EXPECT_EQ(outcome.time_s, 0.5);
  EXPECT_NEAR(outcome.gap_m, -0.05, 1e-6);
}

TEST(CrowdEpisode, CountsTheStepsThatComeTooNear) {
  StraightRobot robot(kEastwards.start, {1.0, 0.0});
  // 0.75 m between the centres at x = 0: nearer than 0.8 m for 0.56 m of way.
  const CrowdOutcome outcome = drive({kEastwards, {standing(0.0, 0.75)}}, false, robot);
  EXPECT_EQ(outcome.success_count, 1.0);
  EXPECT_NEAR(outcome.gap_m, 0.15, 1e-6);
  EXPECT_EQ(outcome.near_count, 4.0);
}

TEST(CrowdEpisode, PeopleGiveWayOnlyToARobotThatTheySee) {
  const CrowdScenario head_on = {kEastwards, {{{7.5, 0.05}, {-7.5, 0.05}}}};
  StraightRobot seen(kEastwards.start, {1.0, 0.0});
  StraightRobot unseen(kEastwards.start, {1.0, 0.0});
  EXPECT_EQ(drive(head_on, true, seen).collision_count, 0.0);
  EXPECT_EQ(drive(head_on, false, unseen).collision_count, 1.0);
}

TEST(CrowdEpisode, CountsWhoseVelocityTheRobotChanges) {
  // Someone who walks beside the robot is seen, from the third step on, and not disturbed.
  const CrowdScenario aside = {kEastwards, {{{-7.5, 3.0}, {9.5, 3.0}}}};
  StraightRobot robot(kEastwards.start, {1.0, 0.0});
  const CrowdOutcome outcome = drive(aside, false, robot);
  EXPECT_EQ(outcome.seen_count, 14.5 / 0.25 - 2.0);
  EXPECT_EQ(outcome.disturbed_quarter_count, 0.0);
  // Head on, he swerves; he is near for a part of the way only.
  const CrowdScenario head_on = {kEastwards, {{{7.5, 0.05}, {-7.5, 0.05}}}};
  StraightRobot disturbing(kEastwards.start, {1.0, 0.0});
  const CrowdOutcome swerve = drive(head_on, true, disturbing);
  EXPECT_GT(swerve.disturbed_quarter_count, 0.0);
  EXPECT_GE(swerve.disturbed_quarter_count, swerve.disturbed_half_count);
  EXPECT_GE(swerve.disturbed_half_count, swerve.disturbed_count);
  EXPECT_LT(swerve.seen_count, outcome.seen_count / 2.0);
}

// Another implementation of the protocol (RVO2, 5000 scenarios of its own): 99.9 % success, 15.42
// s, 14.60 m; robot invisible: 94.5 % success, 4.2 % collisions, 16.39 s. Tolerances are three
// standard deviations of the difference.
TEST(CrowdEpisode, OfAHolonomicOrcaRobotGoAsInAnotherImplementation) {
  constexpr int kRuns = 2000;
  for (const bool visible : {true, false}) {
    double success = 0.0;
    double collision = 0.0;
    double time = 0.0;
    for (int run = 0; run < kRuns; ++run) {
      const CrowdScenario scenario = crowd_scenario(11, run);
      HolonomicOrcaRobot robot(scenario.robot.start, scenario.robot.goal);
      const CrowdOutcome outcome = drive(scenario, visible, robot);
      success += outcome.success_count;
      collision += outcome.collision_count;
      if (outcome.success_count > 0.0) time += outcome.time_s;
    }
    EXPECT_NEAR(success / kRuns, visible ? 0.999 : 0.945, visible ? 0.003 : 0.019);
    EXPECT_NEAR(collision / kRuns, visible ? 0.0 : 0.042, visible ? 0.0 : 0.016);
    EXPECT_NEAR(time / success, visible ? 15.42 : 16.39, visible ? 0.08 : 0.15);
  }
}

}  // namespace
}  // namespace headland
