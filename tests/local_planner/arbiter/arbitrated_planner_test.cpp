// SPDX-License-Identifier: Apache-2.0
#include "local_planner/arbiter/arbitrated_planner.hpp"

#include <gtest/gtest.h>

#include "local_planner/fail_safe/fail_safe_planner.hpp"
#include "local_planner/mcts/mcts_planner.hpp"
#include "tests/local_planner/episode.hpp"
#include "tests/local_planner/planner_laws.hpp"

namespace headland::test {
namespace {

std::unique_ptr<ArbitratedPlanner> make(const Vehicle& vehicle) {
  return std::make_unique<ArbitratedPlanner>(vehicle, ArbiterConfig{},
                                             std::make_unique<FailSafePlanner>(vehicle),
                                             std::make_unique<MctsPlanner>(vehicle, MctsConfig{}));
}

TEST(ArbitratedPlanner, KeepsTheLawsOfPlanners) { expect_planner_laws(make, {30, {}}); }

TEST(ArbitratedPlanner, DrivesAroundSomebodyWhoStandsOnThePathAndComesBackToIt) {
  Path path;
  path.append_straight({0.0, 0.0, 0.0}, 40.0, 0);
  for (const Vehicle& vehicle : {field_robot(), rover()}) {
    const auto planner = make(vehicle);
    const LocalGoal goal{&path, 0.0, {40.0, 0.0}, 0.5, 1.2, 40.0};
    const Episode e = drive(vehicle, *planner, nullptr, goal, {Walker{{14.0, 0.0}, {0.0, 0.0}}});
    EXPECT_TRUE(e.reached) << vehicle.name;
    EXPECT_EQ(planner->arbiter().takeovers(), 1) << vehicle.name;
    EXPECT_EQ(planner->arbiter().driving(), Driving::kPath) << vehicle.name;
    EXPECT_GT(e.farthest_off, 0.5) << vehicle.name;
    EXPECT_LT(std::abs(e.end.pose.y), 0.4) << vehicle.name;
  }
}

}  // namespace
}  // namespace headland::test
