// SPDX-License-Identifier: Apache-2.0
#include "local_planner/velocity_obstacle/velocity_obstacle.hpp"

#include <array>

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
    EXPECT_LT(e.farthest_off, 2.0) << vehicle.name << ": it cuts corners, but not more";
  }
}

// At 1 m/s. At 1.2 m/s the cars do not get by without a touch: the fail-safe has to lie beneath.
TEST(VelocityObstacle, PassesWhoCrossesWithoutGivingWay) {
  const Path path = curved_path();
  VelocityObstacleConfig config;
  config.share_ratio = 1.0;
  for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
    for (const double side : {-1.0, 1.0}) {
      VelocityObstacle planner(vehicle, config);
      const LocalGoal goal{&path, 0.0, {15.0, 0.0}, 1.2, 1.0};
      const Episode e =
          drive(vehicle, planner, nullptr, goal, {{{8.0, 8.0 * side}, {0.0, -1.2 * side}}});
      EXPECT_TRUE(e.reached) << vehicle.name;
      EXPECT_GT(e.least_gap, 0.0) << vehicle.name;
    }
  }
}

// Two vehicles on each other's path. Tractors, which are slower to steer, block each other.
TEST(VelocityObstacle, TwoOfItsKindPassEachOther) {
  for (const Vehicle& vehicle : {field_robot(), rover()}) {
    const OutlineDisc disc(vehicle.footprint);
    std::array<VelocityObstacle, 2> planners{VelocityObstacle(vehicle), VelocityObstacle(vehicle)};
    std::array<VehicleState, 2> robots;
    robots[1].pose = {24.0, 1.0, kPi};
    const std::array<LocalGoal, 2> goals{LocalGoal{nullptr, 0.0, {24.0, 1.0}, 1.0, 1.2},
                                         LocalGoal{nullptr, 0.0, {0.0, 0.0}, 1.0, 1.2}};
    std::array<bool, 2> reached{};
    double nearest = 1e9;
    LocalPlan plan;
    for (double time = 0.0; time < 40.0; time += 0.3) {
      std::array<VehicleState, 2> next;
      for (std::size_t i = 0; i < 2; ++i) {
        const VehicleState& other = robots[1 - i];
        Agent agent;
        agent.position = disc.centre(other.pose);
        agent.velocity = other.speed * other.pose.heading();
        agent.radius_m = 0.5 * vehicle.footprint.width_m;
        planners[i].plan({time, {robots[i]}, {&agent, 1}}, goals[i], {}, plan);
        next[i] = plan.at(time + 0.3);
        reached[i] = reached[i] || (next[i].pose.position() - goals[i].place).norm() < 1.0;
      }
      robots = next;
      nearest =
          std::min(nearest, (disc.centre(robots[0].pose) - disc.centre(robots[1].pose)).norm());
    }
    EXPECT_TRUE(reached[0] && reached[1]) << vehicle.name;
    EXPECT_GT(nearest, vehicle.footprint.width_m) << vehicle.name;
  }
}

TEST(VelocityObstacle, KeepsItsBuffers) {
  RandomStream random(3, "buffers");
  OwnedScene owned;
  owned.agents = crowd(50, 12.0, random);
  owned.map = ClearanceMap::of({box(5.0, 4.0, 8.0, 6.0)});
  const LocalGoal goal{nullptr, 0.0, {15.0, 0.0}, 1.0, 1.2};
  const Vehicle vehicle = field_robot();
  VelocityObstacle planner(vehicle);
  LocalPlan plan;
  for (int i = 0; i < 3; ++i) planner.plan(owned.view(0.3 * i), goal, {}, plan);
  const long before = headland::testing::allocation_count();
  planner.plan(owned.view(0.9), goal, {}, plan);
  EXPECT_EQ(headland::testing::allocation_count(), before);
}

}  // namespace
}  // namespace headland::test
