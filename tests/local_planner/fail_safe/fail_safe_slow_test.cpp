// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/clock.hpp"
#include "tests/local_planner/fail_safe/encounters.hpp"
#include "tests/local_planner/planner_laws.hpp"
#include "tests/local_planner/vehicles.hpp"

namespace headland::test {
namespace {

struct Tally {
  double driven = 0.0;
  double wanted = 0.0;
  double stopped = 0.0;
  double duration = 0.0;
  int touched = 0;
  double worst_closing = 0.0;

  double availability() const { return driven / wanted; }
};

// `count` encounters of all behaviours in turn, in three vehicles.
std::array<Tally, kBehaviors> meet(int count, const FailSafeConfig& config, double acceleration) {
  std::array<Tally, kBehaviors> tallies{};
  for (int i = 0; i < count; ++i) {
    RandomStream random(static_cast<std::uint64_t>(i), "encounters");
    const int behavior = i % kBehaviors;
    const int kind = i / kBehaviors % 3;
    const Vehicle vehicle = kind == 0 ? field_robot() : kind == 1 ? tractor() : rover();
    const Encounter e =
        encounter(vehicle, config, static_cast<Behavior>(behavior),
                  random.uniform(0.5, vehicle.transit_speed_mps), acceleration, random);
    EXPECT_LE(e.worst_closing, 0.05) << "encounter " << i << ", " << kBehaviorNames[i % kBehaviors];
    Tally& tally = tallies[static_cast<std::size_t>(behavior)];
    tally.driven += e.driven;
    tally.wanted += e.wanted;
    tally.stopped += e.stopped;
    tally.duration += e.duration;
    tally.touched += e.touched ? 1 : 0;
    tally.worst_closing = std::max(tally.worst_closing, e.worst_closing);
  }
  std::printf("%-18s way driven  time stopped  walked into  fastest touch\n", "");
  for (int b = 0; b < kBehaviors; ++b) {
    const Tally& t = tallies[static_cast<std::size_t>(b)];
    std::printf("%-18s %8.3f %12.3f %12d %12.3f m/s\n", kBehaviorNames[b].data(), t.availability(),
                t.stopped / t.duration, t.touched, t.worst_closing);
  }
  return tallies;
}

double way_driven(const std::array<Tally, kBehaviors>& tallies, Behavior behavior) {
  return tallies[static_cast<std::size_t>(behavior)].availability();
}

TEST(FailSafe, InTenThousandEncountersTheRobotDrivesIntoNobody) {
  const auto tallies = meet(10000, {}, 0.0);
  // And it is no standing stone.
  EXPECT_GT(way_driven(tallies, Behavior::kStraight), 0.8);
  EXPECT_GT(way_driven(tallies, Behavior::kStands), 0.4);
  EXPECT_GT(way_driven(tallies, Behavior::kCrosses), 0.4);
  EXPECT_GT(way_driven(tallies, Behavior::kFromBehind), 0.4);
}

TEST(FailSafe, ByObservedVelocitiesItDrivesIntoNobodyEither) {
  FailSafeConfig config;
  config.agents = AgentMotion::kObserved;
  const auto tallies = meet(4000, config, config.agent_acceleration_mps2);
  EXPECT_GT(way_driven(tallies, Behavior::kStraight), 0.85);
  EXPECT_GT(way_driven(tallies, Behavior::kStands), 0.5);
}

TEST(FailSafe, ACheckAmongFiftyAgentsTakesLessThanAFifthOfAMillisecond) {
  RandomStream random(1, "cost");
  std::vector<Polygon> walls;
  for (int i = 0; i < 20; ++i) {
    const double x = random.uniform(-15.0, 15.0);
    const double y = random.uniform(5.0, 15.0);
    walls.push_back(box(x, y, x + 1.0, y + 1.0));
  }
  const ClearanceMap map = ClearanceMap::of(walls);
  const ThreadClock clock;
  for (const AgentMotion motion : {AgentMotion::kWorstCase, AgentMotion::kObserved}) {
    FailSafeConfig config;
    config.agents = motion;
    double total = 0.0;
    double worst = 0.0;
    const int count = 2000;
    for (int i = 0; i < count; ++i) {
      FailSafe fail_safe(field_robot(), config);
      const std::vector<Agent> agents = crowd(50, 8.0, random);
      VehicleState robot;
      robot.speed = random.uniform(0.0, 1.5);
      robot.steering = random.uniform(-0.5, 0.5);
      const LocalScene scene{0.0, robot, agents, &map, 0.1};
      const double begin = clock.now();
      fail_safe.limit(scene, {1.5, random.uniform(-0.5, 0.5), 0.0});
      const double cost = clock.now() - begin;
      total += cost;
      worst = std::max(worst, cost);
    }
    std::printf("50 agents: mean %.1f us, worst %.1f us\n", 1e6 * total / count, 1e6 * worst);
    EXPECT_LT(total / count, 0.2e-3);
  }
}

}  // namespace
}  // namespace headland::test
