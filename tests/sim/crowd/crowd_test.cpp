// SPDX-License-Identifier: Apache-2.0
#include "sim/crowd/crowd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

constexpr double kStep = 0.1;
const Point2 kOrigin(0.0, 0.0);

CrowdAgent walker(const Point2& position, const Point2& goal,
                  Behaviour behaviour = Behaviour::kOrca) {
  CrowdAgent agent;
  agent.behaviour = behaviour;
  agent.position = position;
  agent.goal = goal;
  return agent;
}

Region square(double side) {
  return Region({{{{0.0, 0.0}, {side, 0.0}, {side, side}, {0.0, side}}, {}}});
}

std::vector<CrowdAgent> scattered(int count, double side, std::uint64_t seed) {
  RandomStream random(seed, "scattered");
  std::vector<CrowdAgent> agents;
  while (static_cast<int>(agents.size()) < count) {
    const auto place = [&] { return Point2(random.uniform(0.0, side), random.uniform(0.0, side)); };
    const Point2 p = place();
    const bool free = std::none_of(agents.begin(), agents.end(), [&p](const CrowdAgent& other) {
      return (other.position - p).norm() < 1.2;
    });
    if (free) agents.push_back(walker(p, place()));
  }
  return agents;
}

double least_distance(std::span<const Agent> agents) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < agents.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      least = std::min(least, (agents[i].position - agents[j].position).norm());
    }
  }
  return least;
}

bool all_finite(std::span<const Agent> agents) {
  return std::all_of(agents.begin(), agents.end(), [](const Agent& agent) {
    return agent.position.allFinite() && agent.velocity.allFinite();
  });
}

TEST(Crowd, AgentsOfASparseCrowdGoToGoalAfterGoalWithoutTouching) {
  // Seed 003's sparse crowd: 50 m2 an agent. Where three meet there may be no velocity that all
  // permit, so they touch by less than 1 % of their radius.
  Crowd crowd({}, scattered(50, 50.0, 1), {}, 1, goals_within(square(50.0)));
  double way = 0.0;
  for (int i = 0; i < 1200; ++i) {
    crowd.step(kStep);
    ASSERT_GT(least_distance(crowd.agents()), 1.0 - 0.01 * 0.5) << "step " << i;
    for (const Agent& agent : crowd.agents()) way += kStep * agent.velocity.norm();
  }
  EXPECT_GT(way / 50.0, 0.8 * 120.0);  // of 1 m/s
}

TEST(Crowd, AnAgentWithoutARuleOfGoalsStopsAtItsGoal) {
  Crowd crowd({}, {walker({0.0, 0.0}, {5.0, 0.0})});
  for (int i = 0; i < 200; ++i) crowd.step(kStep);
  EXPECT_LT((crowd.agents()[0].position - Point2(5.0, 0.0)).norm(), 0.01);
  EXPECT_LT(crowd.agents()[0].velocity.norm(), 1e-3);
}

TEST(Crowd, SameSeedSameBytesAndTheOrderOfAgentsDoesNotMatter) {
  CrowdConfig config;
  config.nudge_mps = 0.0;
  auto agents = scattered(60, 25.0, 2);
  Crowd first(config, agents);
  Crowd again(config, agents);
  std::reverse(agents.begin(), agents.end());
  Crowd reversed(config, agents);
  for (int i = 0; i < 100; ++i) {
    for (Crowd* crowd : {&first, &again, &reversed}) crowd->step(kStep);
  }
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_EQ(first.agents()[i].position, again.agents()[i].position);
    EXPECT_EQ(first.agents()[i].position, reversed.agents()[59 - i].position);
  }
}

TEST(Crowd, SeedsDiffer) {
  const auto agents = scattered(20, 20.0, 3);
  Crowd one({}, agents, {}, 1, goals_within(square(20.0)));
  Crowd two({}, agents, {}, 2, goals_within(square(20.0)));
  for (int i = 0; i < 300; ++i) {
    one.step(kStep);
    two.step(kStep);
  }
  EXPECT_GT((one.agents()[0].position - two.agents()[0].position).norm(), 0.1);
}

// ---- Robots

// A robot that drives along y = 0 towards an agent that stands in its way; how near it comes, and
// where the agent is when it has passed.
double nearest_to_robot(Behaviour behaviour, double share, Point2* end) {
  Crowd crowd({}, {walker({0.0, 0.1}, {0.0, 0.1}, behaviour)});
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 200; ++i) {
    CrowdRobot robot;
    robot.position = {-10.0 + 0.1 * i, 0.0};
    robot.velocity = {1.0, 0.0};
    robot.share = share;
    crowd.step(kStep, {&robot, 1});
    least = std::min(least, (crowd.agents()[0].position - robot.position).norm());
  }
  *end = crowd.agents()[0].position;
  return least;
}

TEST(Crowd, AgentsThatTakeOnAllOfItKeepTheRobotsRadiusAndTheirOwn) {
  Point2 end;
  EXPECT_GT(nearest_to_robot(Behaviour::kOrca, 1.0, &end), 2.0 - 0.11);  // it moved after the look
}

TEST(Crowd, NobodySeesARobotOfShareZeroAndBlindAgentsSeeNone) {
  Point2 end;
  EXPECT_LT(nearest_to_robot(Behaviour::kOrca, 0.0, &end), 0.2);
  EXPECT_LT((end - Point2(0.0, 0.1)).norm(), 1e-2);
  EXPECT_LT(nearest_to_robot(Behaviour::kOrcaBlind, 1.0, &end), 0.2);
  EXPECT_LT(nearest_to_robot(Behaviour::kIgnore, 1.0, &end), 0.2);
}

TEST(Crowd, BlindAgentsSeeOtherAgents) {
  Crowd crowd({}, {walker({0.0, 0.0}, {10.0, 0.0}, Behaviour::kOrcaBlind),
                   walker({10.0, 0.2}, {0.0, 0.2}, Behaviour::kOrcaBlind)});
  double least = 10.0;
  for (int i = 0; i < 150; ++i) {
    crowd.step(kStep);
    least = std::min(least, least_distance(crowd.agents()));
  }
  EXPECT_GT(least, 1.0 - 1e-3);
  EXPECT_LT((crowd.agents()[0].position - Point2(10.0, 0.0)).norm(), 0.1);
}

TEST(Crowd, AnAgentAvoidsOneThatIgnoresAllByItself) {
  Crowd crowd(
      {}, {walker({0.0, 0.0}, {10.0, 0.0}), walker({10.0, 0.2}, {0.0, 0.2}, Behaviour::kIgnore)});
  double least = 10.0;
  double off = 0.0;
  for (int i = 0; i < 150; ++i) {
    crowd.step(kStep);
    least = std::min(least, least_distance(crowd.agents()));
    off = std::max(off, std::abs(crowd.agents()[1].position.y() - 0.2));
  }
  EXPECT_GT(least, 1.0 - 1e-3);
  EXPECT_LT(off, 1e-2);
}

// ---- Herds

CrowdAgent animal(AgentKind kind, const Point2& position) {
  CrowdAgent agent = walker(position, position, Behaviour::kHerd);
  agent.kind = kind;
  agent.radius_m = kind == AgentKind::kCattle ? 0.9 : 0.4;
  return agent;
}

TEST(Crowd, SheepFleeARobotToTheirOwnFlightDistanceAndNoFarther) {
  for (const double flight : {-1.0, 4.0}) {
    CrowdAgent sheep = animal(AgentKind::kSheep, {2.0, 0.5});
    sheep.flight_m = flight;
    Crowd crowd({}, {sheep});
    const CrowdRobot robot;
    for (int i = 0; i < 300; ++i) crowd.step(kStep, {&robot, 1});
    const double distance = crowd.agents()[0].position.norm();
    const double expected = flight < 0.0 ? HerdModel{}.flight_m : flight;
    EXPECT_GT(distance, expected - 0.2);
    EXPECT_LT(distance, expected + 4.0);  // then it grazes
  }
}

TEST(Crowd, AnimalsFearPeopleAndDogsButNotEachOtherNorRobotsThatNobodySees) {
  const auto flown = [](const CrowdAgent& other, double share) {
    CrowdAgent still = other;
    still.position = still.goal = {4.0, 0.0};
    still.speed_mps = 0.0;
    Crowd crowd({}, {animal(AgentKind::kCattle, {0.0, 0.0}), still});
    CrowdRobot robot;
    robot.position = {0.0, 4.0};
    robot.share = share;
    for (int i = 0; i < 20; ++i) crowd.step(kStep, {&robot, 1});
    return crowd.agents()[0].position.norm();
  };
  CrowdAgent dog = walker(kOrigin, kOrigin);
  dog.kind = AgentKind::kDog;
  EXPECT_GT(flown(walker(kOrigin, kOrigin), 0.0), 0.6);
  EXPECT_GT(flown(dog, 0.0), 0.6);
  EXPECT_GT(flown(animal(AgentKind::kSheep, kOrigin), 0.5), 0.6);
  EXPECT_LT(flown(animal(AgentKind::kSheep, kOrigin), 0.0), 0.4);
}

TEST(Crowd, AFlockInAFenceStaysInsideWhateverChasesIt) {
  std::vector<CrowdAgent> flock;
  for (int i = 0; i < 30; ++i) {
    flock.push_back(animal(AgentKind::kSheep, {6.0 + 1.2 * (i % 6), 6.0 + 1.2 * (i / 6)}));
  }
  const Polyline fence = {{0.0, 0.0}, {0.0, 20.0}, {20.0, 20.0}, {20.0, 0.0}};
  Crowd crowd({}, flock, OrcaObstacles({fence}), 4);
  for (int i = 0; i < 600; ++i) {
    CrowdRobot robot;
    robot.position = {10.0 + 7.0 * std::cos(0.02 * i), 10.0 + 7.0 * std::sin(0.02 * i)};
    robot.velocity = 1.4 * Point2(-std::sin(0.02 * i), std::cos(0.02 * i));
    crowd.step(kStep, {&robot, 1});
    for (const Agent& sheep : crowd.agents()) {
      ASSERT_GT(sheep.position.minCoeff(), 0.4 - 1e-6) << "step " << i;
      ASSERT_LT(sheep.position.maxCoeff(), 19.6 + 1e-6) << "step " << i;
      ASSERT_LE(sheep.velocity.norm(), HerdModel{}.run_mps + 1e-9);
    }
  }
}

// ---- Replay

TrackSet one_track() {
  return {
      "one", 1.0, {{7, AgentKind::kDog, {2.0, 3.0, 4.0}, {{0.0, 0.0}, {1.0, 0.0}, {1.0, 2.0}}}}};
}

TEST(Crowd, TheRecordedAreThereWhileTheirTracksLastAndMoveAsRecorded) {
  Crowd crowd({}, {walker({50.0, 0.0}, {50.0, 0.0})});
  crowd.replay(one_track(), Pose2{10.0, 0.0, 0.5 * kPi}, 1.0);
  EXPECT_EQ(crowd.agents().size(), 1u);
  while (crowd.time_s() < 3.45) crowd.step(kStep);
  ASSERT_EQ(crowd.agents().size(), 2u);
  const Agent& dog = crowd.agents()[1];
  EXPECT_EQ(dog.id, 1);
  EXPECT_EQ(dog.kind, AgentKind::kDog);
  EXPECT_LT((dog.position - Point2(10.0, 0.5)).norm(), 1e-9);
  EXPECT_LT((dog.velocity - Point2(0.0, 1.0)).norm(), 1e-9);
  while (crowd.time_s() < 5.05) crowd.step(kStep);
  EXPECT_EQ(crowd.agents().size(), 1u);
}

TEST(Crowd, AgentsGiveWayToTheRecorded) {
  TrackSet tracks{"two", 1.0, {{1, AgentKind::kPerson, {0.0, 20.0}, {{10.0, 0.2}, {-10.0, 0.2}}}}};
  Crowd crowd({}, {walker({0.0, 0.0}, {10.0, 0.0})});
  crowd.replay(tracks);
  double least = 10.0;
  for (int i = 0; i < 150; ++i) {
    crowd.step(kStep);
    least = std::min(least, least_distance(crowd.agents()));
  }
  EXPECT_GT(least, 0.5 + 0.3 - 1e-3);
}

// ---- Whatever the input

TEST(Crowd, AgentsOnTopOfEachOtherAndOfARobotComeApart) {
  std::vector<CrowdAgent> agents(8, walker({1.0, 1.0}, {1.0, 1.0}));
  Crowd crowd({}, agents);
  CrowdRobot robot;
  robot.position = {1.0, 1.0};
  for (int i = 0; i < 100; ++i) {
    crowd.step(kStep, {&robot, 1});
    ASSERT_TRUE(all_finite(crowd.agents()));
  }
  EXPECT_GT(least_distance(crowd.agents()), 0.9);
  for (const Agent& agent : crowd.agents()) {
    EXPECT_GT((agent.position - robot.position).norm(), 1.9);
  }
}

TEST(Crowd, WhatIsNoNumberIsLeftOutAndTheOthersKeepTheirIds) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  std::vector<CrowdAgent> agents(5, walker({0.0, 0.0}, {9.0, 0.0}));
  agents[0].position.x() = nan;
  agents[1].velocity.y() = inf;
  agents[2].speed_mps = nan;
  agents[4].position = {3.0, 0.0};
  agents[4].radius_m = -1.0;
  Crowd crowd({}, agents);
  ASSERT_EQ(crowd.agents().size(), 2u);
  EXPECT_EQ(crowd.agents()[0].id, 3);
  EXPECT_EQ(crowd.agents()[1].id, 4);
  std::vector<CrowdRobot> robots(3);
  robots[0].position = {nan, 0.0};
  robots[1].velocity = {inf, 0.0};
  robots[2].share = nan;
  for (int i = 0; i < 10; ++i) crowd.step(kStep, robots);
  crowd.step(nan);
  crowd.step(-1.0);
  EXPECT_NEAR(crowd.time_s(), 1.0, 1e-9);
  EXPECT_TRUE(all_finite(crowd.agents()));
  EXPECT_GT(crowd.agents()[0].velocity.x(), 0.9);
}

TEST(Crowd, NumbersAtTheEndOfTheScaleStayNumbers) {
  std::vector<CrowdAgent> agents;
  for (const double big : {1e18, 1e160, 1e308, -1e308}) {
    agents.push_back(walker({big, 0.0}, {-big, big}));
    agents.push_back(walker({0.0, big}, {big, big}, Behaviour::kIgnore));
    agents.push_back(animal(AgentKind::kSheep, {big, -big}));
    agents.back().radius_m = std::abs(big);
    agents.push_back(walker({0.0, 0.0}, {1.0, 0.0}));
    agents.back().max_speed_mps = agents.back().speed_mps = std::abs(big);
    agents.back().velocity = {-big, big};
  }
  Crowd crowd({}, agents, OrcaObstacles({{{0.0, -1e308}, {1.0, 1e308}}}));
  std::vector<CrowdRobot> robots(2);
  robots[0].position = {1e308, 0.0};
  robots[1].radius_m = 1e300;
  for (const double dt : {1e-300, 0.1, 1e300}) {
    for (int i = 0; i < 10; ++i) crowd.step(dt, robots);
    EXPECT_TRUE(all_finite(crowd.agents())) << dt;
  }
}

TEST(Crowd, NobodyAndThousandsAreFine) {
  Crowd nobody({}, {});
  nobody.step(kStep);
  EXPECT_TRUE(nobody.agents().empty());
  std::vector<CrowdAgent> agents;
  RandomStream random(5, "thousands");
  for (int i = 0; i < 4000; ++i) {
    agents.push_back(walker({random.uniform(0.0, 40.0), random.uniform(0.0, 40.0)}, {20.0, 20.0}));
  }
  Crowd thousands({}, agents);
  for (int i = 0; i < 10; ++i) thousands.step(kStep);
  EXPECT_TRUE(all_finite(thousands.agents()));
}

TEST(Crowd, AStepDoesNotAllocate) {
  auto agents = scattered(80, 30.0, 6);
  for (std::size_t i = 0; i < agents.size(); i += 4) agents[i].behaviour = Behaviour::kHerd;
  for (std::size_t i = 1; i < agents.size(); i += 8) agents[i].behaviour = Behaviour::kIgnore;
  const OrcaObstacles tree({{{10.0, 10.0}, {12.0, 10.0}, {12.0, 12.0}, {10.0, 12.0}}});
  Crowd crowd({}, agents, tree);
  crowd.replay(one_track());
  const CrowdRobot robot;
  for (int i = 0; i < 5; ++i) crowd.step(kStep, {&robot, 1});
  const long before = testing::allocation_count();
  for (int i = 0; i < 15; ++i) crowd.step(kStep, {&robot, 1});
  EXPECT_EQ(testing::allocation_count(), before);
}

TEST(Crowd, GoalsLieInTheAreaAndInNoneWhereThereIsNone) {
  const Region area({{{{0.0, 0.0}, {4.0, 0.0}, {0.0, 4.0}}, {}}});
  RandomStream random(7, "goals");
  const GoalRule rule = goals_within(area);
  for (int i = 0; i < 200; ++i) {
    const auto goal = rule({}, random);
    ASSERT_TRUE(goal);
    EXPECT_TRUE(area.contains(*goal));
  }
  EXPECT_FALSE(goals_within(Region{})({}, random));
}

}  // namespace
}  // namespace headland
