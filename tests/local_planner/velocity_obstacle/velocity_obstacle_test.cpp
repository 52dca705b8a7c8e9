// SPDX-License-Identifier: Apache-2.0
#include "local_planner/velocity_obstacle/velocity_obstacle.hpp"

#include <gtest/gtest.h>

#include "tests/local_planner/episode.hpp"
#include "tests/local_planner/planner_laws.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland::test {
namespace {

TEST(VelocityObstacle, KeepsTheLawsOfPlanners) {
  expect_planner_laws(
      [](const Vehicle& vehicle) { return std::make_unique<VelocityObstacle>(vehicle); });
}

TEST(VelocityObstacle, WithNobodyThereItFollowsThePath) {
  const Path path = curved_path();
  for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
    VelocityObstacle planner(vehicle);
    const LocalGoal goal{&path, 0.0, path.end_pose().position(), 0.5, 1.2};
    const Episode e = drive(vehicle, planner, nullptr, goal, {});
    EXPECT_TRUE(e.reached) << vehicle.name;
    EXPECT_LT(e.duration, 1.25 * path.length() / 1.2) << vehicle.name;
    EXPECT_LT(e.farthest_off, 0.3) << vehicle.name;
  }
}

struct Case {
  const char* name;
  std::vector<Walker> walkers;
};

TEST(VelocityObstacle, PassesWhoDoesNotGiveWay) {
  const Path path = curved_path();
  VelocityObstacleConfig config;
  config.share_ratio = 1.0;
  const Case cases[] = {{"crosses", {{{8.0, -8.0}, {0.0, 1.2}}}},
                        {"comes", {{{14.0, 0.1}, {-1.0, 0.0}}}},
                        {"stands", {{{8.0, 0.0}, {0.0, 0.0}}}},
                        {"two stand", {{{7.0, 0.4}, {0.0, 0.0}}, {{7.5, -0.8}, {0.0, 0.0}}}}};
  for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
    for (const Case& c : cases) {
      VelocityObstacle planner(vehicle, config);
      const LocalGoal goal{&path, 0.0, {15.0, 0.0}, 0.5, 1.2};
      const Episode e = drive(vehicle, planner, nullptr, goal, c.walkers);
      std::printf("%s %s: reached %d in %.1f, gap %.2f stand %.1f off %.2f\n", vehicle.name.c_str(),
                  c.name, e.reached, e.duration, e.least_gap, e.longest_stand, e.farthest_off);
      EXPECT_TRUE(e.reached) << vehicle.name << ", " << c.name;
      EXPECT_GT(e.least_gap, 0.0) << vehicle.name << ", " << c.name;
      FailSafeConfig observed;
      observed.agents = AgentMotion::kObserved;
      FailSafe fail_safe(vehicle, observed);
      VelocityObstacle again(vehicle, config);
      const Episode safe = drive(vehicle, again, &fail_safe, goal, c.walkers);
      std::printf("   with fail-safe %s %s: reached %d in %.1f, gap %.2f stand %.1f off %.2f\n",
                  vehicle.name.c_str(), c.name, safe.reached, safe.duration, safe.least_gap,
                  safe.longest_stand, safe.farthest_off);
      EXPECT_LT(safe.hardest_hit, 0.05) << vehicle.name << ", " << c.name;
    }
  }
}

}  // namespace
}  // namespace headland::test
