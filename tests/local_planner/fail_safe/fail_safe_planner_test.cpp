// SPDX-License-Identifier: Apache-2.0
#include "local_planner/fail_safe/fail_safe_planner.hpp"

#include <gtest/gtest.h>

#include "tests/local_planner/episode.hpp"
#include "tests/local_planner/planner_laws.hpp"

namespace headland::test {
namespace {

TEST(FailSafePlanner, KeepsTheLawsOfPlanners) {
  expect_planner_laws(
      [](const Vehicle& vehicle) { return std::make_unique<FailSafePlanner>(vehicle); });
}

TEST(FailSafePlanner, FollowsThePath) {
  const Path path = curved_path();
  for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
    FailSafePlanner planner(vehicle);
    FailSafe fail_safe(vehicle);
    const LocalGoal goal{&path, 0.0, path.end_pose().position(), 0.5, 1.2};
    const Episode e = drive(vehicle, planner, &fail_safe, goal, {});
    EXPECT_TRUE(e.reached) << vehicle.name;
    EXPECT_LT(e.duration, 1.25 * path.length() / 1.2) << vehicle.name;
    EXPECT_LT(e.farthest_off, 0.3) << vehicle.name;
  }
}

TEST(FailSafePlanner, ReversesWhereThePathDoes) {
  Path path;
  path.append_straight({0.0, 0.0, 0.0}, 6.0, 0);
  path.append(PathPiece{path.end_pose(), 0.2, 5.0, Gear::kReverse, 0, 0.0});
  for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
    FailSafePlanner planner(vehicle);
    const LocalGoal goal{&path, 0.0, path.end_pose().position(), 0.3, 1.0};
    const Episode e = drive(vehicle, planner, nullptr, goal, {});
    EXPECT_TRUE(e.reached) << vehicle.name;
    EXPECT_LT(e.end.speed, 0.0) << vehicle.name;
    EXPECT_GT(e.driven, 10.0) << vehicle.name;
  }
}

TEST(FailSafePlanner, WaitsUntilTheWayIsFree) {
  const Path path = curved_path();
  for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
    FailSafePlanner planner(vehicle);
    FailSafe fail_safe(vehicle);
    const LocalGoal goal{&path, 0.0, {15.0, 0.0}, 0.5, 1.2};
    const Walker crosses{{8.0, -8.0}, {0.0, 1.2}};
    const Walker stands_then_leaves{{9.0, 0.2}, {0.3, 1.0}, 20.0};
    const Walker comes_and_turns_aside{{13.0, 0.0}, {-1.0, 0.0}, 0.0, 6.0};
    for (const Walker& walker : {crosses, stands_then_leaves}) {
      const Episode e = drive(vehicle, planner, &fail_safe, goal, {walker});
      EXPECT_TRUE(e.reached) << vehicle.name;
      EXPECT_GT(e.least_gap, 0.3) << vehicle.name;
      EXPECT_LT(e.farthest_off, 0.3) << vehicle.name;
    }
    const Episode e = drive(vehicle, planner, &fail_safe, goal, {stands_then_leaves});
    EXPECT_GT(e.longest_stand, 5.0) << vehicle.name;
    const Episode met = drive(vehicle, planner, &fail_safe, goal, {comes_and_turns_aside});
    EXPECT_FALSE(met.reached) << vehicle.name << ": somebody stands in the way for good";
    EXPECT_LT(met.hardest_hit, 0.05) << vehicle.name;
  }
}

TEST(FailSafePlanner, ReachesAPlaceBesideItWithoutAPath) {
  for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
    for (const Point2& place : {Point2(0.5, 3.0), Point2(-6.0, 1.0), Point2(1.0, -1.5)}) {
      FailSafePlanner planner(vehicle);
      const LocalGoal goal{nullptr, 0.0, place, 0.5, 1.0};
      const Episode e = drive(vehicle, planner, nullptr, goal, {});
      EXPECT_TRUE(e.reached) << vehicle.name << " to " << place.transpose();
    }
  }
}

}  // namespace
}  // namespace headland::test
