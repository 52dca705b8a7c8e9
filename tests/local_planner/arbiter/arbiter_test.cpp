// SPDX-License-Identifier: Apache-2.0
#include "local_planner/arbiter/arbiter.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/local_planner/planner_laws.hpp"

namespace headland::test {
namespace {

// A robot on a straight path, and an arbiter that is asked every 0.2 s.
struct Road {
  explicit Road(const ArbiterConfig& config = {}) : arbiter(field_robot(), config) {
    path.append_straight({0.0, 0.0, 0.0}, 60.0, 0);
  }

  Driving ask(const std::vector<Agent>& agents, const ArbiterView& view = {}) {
    time += 0.2;
    const LocalScene scene{time, robot, agents, nullptr, age};
    const LocalGoal goal{&path, std::max(0.0, robot.pose.x), {60.0, 0.0}, 1.0, 1.2, 60.0};
    return arbiter.decide(scene, goal, view);
  }

  Path path;
  Arbiter arbiter;
  VehicleState robot;
  double time = 0.0;
  double age = 0.0;
};

const std::vector<Agent> kNobody;
const std::vector<Agent> kInTheWay = {agent_at(6.0, 0.0)};

TEST(Arbiter, FollowsThePathWhileNobodyIsNearIt) {
  Road road;
  EXPECT_EQ(road.ask(kNobody), Driving::kPath);
  EXPECT_EQ(road.ask({agent_at(6.0, 5.0)}), Driving::kPath);
  EXPECT_EQ(road.ask({agent_at(40.0, 0.0)}), Driving::kPath) << "beyond the horizon";
  EXPECT_EQ(road.ask({agent_at(6.0, 6.0, 0.0, 1.0)}), Driving::kPath) << "walks away";
  EXPECT_EQ(road.arbiter.takeovers(), 0);
}

TEST(Arbiter, LeavesThePathForSomebodyWhoIsThereOrWillBe) {
  Road there;
  EXPECT_EQ(there.ask(kInTheWay), Driving::kLocal);
  Road will_be;
  EXPECT_EQ(will_be.ask({agent_at(5.0, 5.0, 0.0, -1.25)}), Driving::kLocal) << "crosses";
  EXPECT_EQ(will_be.arbiter.takeovers(), 1);
}

TEST(Arbiter, GivesBackOnlyWhenThePathHasBeenFreeForAWhile) {
  Road road;
  road.ask(kInTheWay);
  EXPECT_EQ(road.ask(kNobody), Driving::kLocal) << "free since now";
  for (int i = 0; i < 3; ++i) EXPECT_EQ(road.ask(kNobody), Driving::kLocal);
  EXPECT_EQ(road.ask(kInTheWay), Driving::kLocal) << "not free";
  for (int i = 0; i < 5; ++i) EXPECT_EQ(road.ask(kNobody), Driving::kLocal) << "a second anew";
  EXPECT_EQ(road.ask(kNobody), Driving::kPath);
  EXPECT_EQ(road.arbiter.takeovers(), 1);
}

TEST(Arbiter, BetweenTakingAndGivingNothingChanges) {
  const std::vector<Agent> between = {agent_at(6.0, 0.75 + 0.3 + 1.25)};  // 1.25 m beside
  Road road;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(road.ask(between), Driving::kPath);
  road.ask(kInTheWay);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(road.ask(between), Driving::kLocal);
}

TEST(Arbiter, GivesBackOnlyOnThePath) {
  Road road;
  road.ask(kInTheWay);
  road.robot.pose.y = 0.5;
  for (int i = 0; i < 7; ++i) EXPECT_EQ(road.ask(kNobody), Driving::kLocal) << "beside it";
  road.robot.pose = {1.0, 0.0, 0.5};
  for (int i = 0; i < 3; ++i) EXPECT_EQ(road.ask(kNobody), Driving::kLocal) << "across it";
  road.robot.pose.yaw = 0.1;
  EXPECT_EQ(road.ask(kNobody), Driving::kPath);
}

TEST(Arbiter, TakesAPathUpFromFartherOffTheLongerItIsFree) {
  const auto seconds_until_back = [](double beside) {
    Road road;
    road.ask(kInTheWay);
    road.robot.pose.y = beside;
    const double begin = road.time;
    while (road.ask(kNobody) == Driving::kLocal && road.time < 100.0) {
    }
    return road.time - begin;
  };
  EXPECT_NEAR(seconds_until_back(0.2), 1.2, 0.21);
  EXPECT_NEAR(seconds_until_back(0.6), 5.2, 0.41);
  EXPECT_GT(seconds_until_back(1.5), 15.0);
  EXPECT_GT(seconds_until_back(2.0), 99.0) << "a tracker could not";
}

TEST(Arbiter, DoesNotLeaveWhereItMayNot) {
  Road road;
  ArbiterView row;
  row.may_leave = false;
  for (int i = 0; i < 50; ++i) EXPECT_EQ(road.ask(kInTheWay, row), Driving::kPath);
  EXPECT_EQ(road.ask(kInTheWay), Driving::kLocal);
}

TEST(Arbiter, WaitsTheLongerTheScarcerTheEnergyAndTheSparserTheCrowd) {
  const auto seconds_until_takeover = [](double spare, const std::vector<Agent>& agents) {
    Road road;
    ArbiterView view;
    view.spare_ratio = spare;
    while (road.ask(agents, view) == Driving::kPath && road.time < 60.0) {
    }
    return road.time - 0.2;
  };
  EXPECT_NEAR(seconds_until_takeover(0.5, kInTheWay), 0.0, 1e-9) << "plenty";
  const double half = seconds_until_takeover(0.05, kInTheWay);
  const double none = seconds_until_takeover(0.0, kInTheWay);
  EXPECT_GT(half, 5.0);
  EXPECT_GT(none, 1.8 * half);
  EXPECT_LT(none, 20.0 + 0.2);
  EXPECT_NEAR(seconds_until_takeover(-3.0, kInTheWay), none, 1e-9) << "never longer";
  std::vector<Agent> crowd = kInTheWay;
  for (int i = 0; i < 15; ++i) crowd.push_back(agent_at(-2.0 - 0.3 * i, 5.0));
  const double among_some = seconds_until_takeover(0.0, crowd);
  EXPECT_LT(among_some, 0.7 * none);
  EXPECT_GT(among_some, 1.0);
  for (int i = 0; i < 20; ++i) crowd.push_back(agent_at(-2.0 - 0.3 * i, -5.0));
  EXPECT_NEAR(seconds_until_takeover(0.0, crowd), 0.0, 1e-9) << "a crowd does not clear";
}

TEST(Arbiter, APauseIsNoWait) {
  ArbiterView scarce;
  scarce.spare_ratio = 0.0;
  Road waiting;
  EXPECT_EQ(waiting.ask(kInTheWay, scarce), Driving::kPath);
  waiting.time += 300.0;
  EXPECT_EQ(waiting.ask(kInTheWay, scarce), Driving::kPath) << "he may have come just now";
  waiting.time -= 200.0;
  EXPECT_EQ(waiting.ask(kInTheWay, scarce), Driving::kPath) << "time went back";
  int asked = 1;
  while (waiting.ask(kInTheWay, scarce) == Driving::kPath && asked < 200) ++asked;
  EXPECT_NEAR(0.2 * asked, waiting.arbiter.wait(0.0), 0.21);

  Road back;
  back.ask(kInTheWay);
  back.ask(kNobody);
  back.robot.pose.y = 1.5;
  back.time += 300.0;
  EXPECT_EQ(back.ask(kNobody), Driving::kLocal) << "free since now, as far as anybody knows";
}

TEST(Arbiter, ItsTimesMayBeNegative) {
  Road road;
  road.time = -1000.0;
  EXPECT_EQ(road.ask(kInTheWay), Driving::kLocal);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(road.ask(kNobody), Driving::kLocal);
  EXPECT_EQ(road.ask(kNobody), Driving::kPath);
}

TEST(Arbiter, KeepsToItsWordOnBadInputAndOldScenes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Road road;
  EXPECT_EQ(road.ask({agent_at(nan, 0.0)}), Driving::kPath);
  road.age = 5.0;
  EXPECT_EQ(road.ask(kInTheWay), Driving::kPath);
  road.age = 0.0;
  road.ask(kInTheWay);
  road.robot.speed = nan;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(road.ask(kNobody), Driving::kLocal);
}

TEST(Arbiter, WithoutAPathTheLocalPlannerDrives) {
  Arbiter arbiter(field_robot());
  const LocalGoal goal{nullptr, 0.0, {9.0, 0.0}, 1.0, 1.0};
  EXPECT_EQ(arbiter.decide(LocalScene{}, goal), Driving::kLocal);
}

}  // namespace
}  // namespace headland::test
