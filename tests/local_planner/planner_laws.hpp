// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "local_planner/local_planner.hpp"
#include "local_planner/rollout.hpp"
#include "tests/local_planner/vehicles.hpp"

namespace headland::test {

// Laws that any LocalPlanner obeys. A planner's own test calls `expect_planner_laws` with its
// factory.

using MakePlanner = std::function<std::unique_ptr<LocalPlanner>(const Vehicle&)>;

/// Whether the plan begins at the scene's robot and the vehicle can drive it, state by state.
inline ::testing::AssertionResult is_drivable(const Vehicle& vehicle, const LocalScene& scene,
                                              const LocalPlan& plan) {
  using ::testing::AssertionFailure;
  if (plan.states.size() < 2) return AssertionFailure() << plan.states.size() << " states";
  if (!(plan.step_s > 0.0)) return AssertionFailure() << "steps of " << plan.step_s << " s";
  const VehicleState& robot = scene.robot.state;
  const VehicleState& first = plan.states.front();
  if (is_finite(robot) && ((first.pose.position() - robot.pose.position()).norm() > 1e-9 ||
                           std::abs(first.speed - robot.speed) > 1e-9)) {
    return AssertionFailure() << "begins elsewhere";
  }
  const double top =
      std::max({vehicle.work_speed_mps, vehicle.transit_speed_mps, std::abs(first.speed)});
  const double dt = plan.step_s;
  for (std::size_t i = 0; i + 1 < plan.states.size(); ++i) {
    const VehicleState& a = plan.states[i];
    const VehicleState& b = plan.states[i + 1];
    if (!is_finite(b)) return AssertionFailure() << "state " << i + 1 << " is no number";
    if (std::abs(b.speed) > top + 1e-6) {
      return AssertionFailure() << "state " << i + 1 << " at " << b.speed << " m/s";
    }
    const Command command{command_through_lag(b.speed, a.speed, vehicle.speed_lag_s, dt),
                          command_through_lag(b.steering, a.steering, vehicle.steering_lag_s, dt),
                          command_through_lag(b.yaw_rate, a.yaw_rate, vehicle.steering_lag_s, dt)};
    const VehicleState next = step_vehicle(vehicle, a, command, dt);
    const double off =
        (next.pose.position() - b.pose.position()).norm() / std::max(1.0, b.pose.position().norm());
    if (off > 1e-6 || std::abs(wrap_angle(next.pose.yaw - b.pose.yaw)) > 1e-6 ||
        std::abs(next.speed - b.speed) > 1e-6 || std::abs(next.steering - b.steering) > 1e-6 ||
        std::abs(next.yaw_rate - b.yaw_rate) > 1e-6) {
      return AssertionFailure() << "no command leads from state " << i << " to the next: speed "
                                << a.speed << " -> " << b.speed << ", steering " << a.steering
                                << " -> " << b.steering << ", off by " << off << " m";
    }
  }
  return ::testing::AssertionSuccess();
}

/// A scene that owns what it shows.
struct OwnedScene {
  std::string name;
  VehicleState robot;
  std::vector<Agent> agents;
  ClearanceMap map;
  double age = 0.0;

  LocalScene view(double time = 0.0) const { return {time, robot, agents, &map, age}; }
};

inline Agent agent_at(double x, double y, double vx = 0.0, double vy = 0.0, double radius = 0.3) {
  Agent agent;
  agent.position = Point2(x, y);
  agent.velocity = Point2(vx, vy);
  agent.radius_m = radius;
  return agent;
}

inline std::vector<Agent> crowd(int count, double half_width, RandomStream& random) {
  std::vector<Agent> agents;
  for (int i = 0; i < count; ++i) {
    agents.push_back(agent_at(random.uniform(-half_width, half_width),
                              random.uniform(-half_width, half_width), random.uniform(-1.5, 1.5),
                              random.uniform(-1.5, 1.5), random.uniform(0.2, 0.6)));
    agents.back().id = i;
  }
  return agents;
}

/// A rectangle, counter-clockwise.
inline Polygon box(double left, double low, double right, double high) {
  return {{{left, low}, {right, low}, {right, high}, {left, high}}, {}};
}

inline std::vector<OwnedScene> nasty_scenes() {
  RandomStream random(5, "scenes");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<OwnedScene> scenes;
  const auto add = [&](std::string name) -> OwnedScene& {
    scenes.push_back({std::move(name), {}, {}, {}, 0.0});
    return scenes.back();
  };
  add("nobody");
  add("500 agents").agents = crowd(500, 15.0, random);
  add("agents on top").agents = {agent_at(0.0, 0.0), agent_at(0.5, 0.1, 1.0), agent_at(0.0, 0.0)};
  add("a position is no number").agents = {agent_at(nan, 3.0)};
  add("a velocity is no number").agents = {agent_at(4.0, 3.0, nan)};
  add("somebody infinitely far").agents = {agent_at(std::numeric_limits<double>::infinity(), 3.0)};
  add("agents of a thousand kilometres").agents = {agent_at(1e6, -1e6, 1e3, 0.0, 1e6)};
  add("every way closed").map = ClearanceMap::around({box(-4.0, -1.5, 5.0, 1.5)});
  add("inside an obstacle").map = ClearanceMap::of({box(-5.0, -5.0, 5.0, 5.0)});
  add("old").age = 10.0;
  add("fast").robot.speed = 3.0;
  add("faster than any").robot.speed = 40.0;
  add("backwards").robot.speed = -1.0;
  OwnedScene& turning = add("turning hard");
  turning.robot = {{2.0, -1.0, 3.1}, 1.0, 0.6, 0.5};
  turning.agents = crowd(20, 8.0, random);
  add("the robot is no number").robot.pose.x = nan;
  add("its steering is no number").robot.steering = nan;
  return scenes;
}

inline std::vector<std::pair<std::string, LocalGoal>> nasty_goals(const Path& path) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  static const Path kNoPath;
  return {{"ahead", {&path, 1.0, {15.0, 0.0}, 1.0, 1.2, 15.0}},
          {"without a path", {nullptr, 0.0, {12.0, 5.0}, 0.5, 1.0}},
          {"empty path", {&kNoPath, 0.0, {12.0, 5.0}, 0.5, 1.0}},
          {"here", {nullptr, 0.0, {0.0, 0.0}, 0.5, 1.0}},
          {"close behind", {nullptr, 0.0, {-1.0, 0.3}, 0.1, 1.0}},
          {"beyond the path", {&path, 1e9, {20.0, 0.0}, 1.0, 1.0, 1e9}},
          {"before the path", {&path, -50.0, {20.0, 0.0}, 1.0, 1.0, -40.0}},
          {"a place beside the path", {&path, 0.0, {20.0, 0.0}, 1.0, 1.0, 15.0}},
          {"another continent", {nullptr, 0.0, {1e7, -1e7}, 1.0, 1.0}},
          {"faster than light", {&path, 0.0, {15.0, 0.0}, 1.0, 1e9, 15.0}},
          {"hardly moving", {&path, 0.0, {15.0, 0.0}, 1.0, 1e-9, 15.0}},
          {"not moving", {&path, 0.0, {15.0, 0.0}, 1.0, 0.0, 15.0}},
          {"accuracy below nothing", {&path, 0.0, {15.0, 0.0}, -1.0, 1.0, 15.0}},
          {"no number", {&path, 0.0, {nan, 0.0}, 1.0, 1.0, 15.0}},
          {"infinite", {&path, 0.0, {inf, 0.0}, 1.0, inf, 15.0}},
          {"progress is no number", {&path, nan, {15.0, 0.0}, 1.0, 1.0, 15.0}}};
}

/// A path ahead, then a curve to the left.
inline Path curved_path() {
  Path path;
  path.append_straight({0.0, 0.0, 0.0}, 15.0, 0);
  path.append(PathPiece{path.end_pose(), 0.2, 8.0, Gear::kForward, 0, 0.0});
  path.append_straight(path.end_pose(), 20.0, 0);
  return path;
}

/// Whatever the input, the plan can be driven; it brakes for what is no number and for old scenes.
inline void expect_plans_are_drivable(const MakePlanner& make, const PlanBudget& budget) {
  const Path path = curved_path();
  LocalPlan plan;
  for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
    for (const OwnedScene& owned : nasty_scenes()) {
      for (const auto& [name, goal] : nasty_goals(path)) {
        SCOPED_TRACE(vehicle.name + ", " + owned.name + ", goal " + name);
        const std::unique_ptr<LocalPlanner> planner = make(vehicle);
        const LocalScene scene = owned.view();
        planner->observe(scene);
        planner->plan(scene, goal, budget, plan);
        EXPECT_TRUE(is_drivable(vehicle, scene, plan));
        const bool good = is_finite(scene, goal) && goal.speed_mps > 0.0;
        EXPECT_EQ(plan.status == LocalStatus::kBadInput, !good);
        EXPECT_EQ(plan.status == LocalStatus::kStale, good && owned.age > 1.0);
        if (::testing::Test::HasFailure()) return;
        planner->plan(scene, goal, PlanBudget{}, plan);
        EXPECT_TRUE(is_drivable(vehicle, scene, plan)) << "without a budget";
      }
    }
  }
}

/// The same sights and budgets give the same plans, bit by bit.
inline void expect_plans_repeat(const MakePlanner& make, const PlanBudget& budget) {
  const Path path = curved_path();
  const LocalGoal goal{&path, 0.0, {15.0, 0.0}, 1.0, 1.2, 15.0};
  for (const Vehicle& vehicle : {field_robot(), rover()}) {
    const auto drive = [&] {
      RandomStream random(11, "repeat");
      const std::unique_ptr<LocalPlanner> planner = make(vehicle);
      OwnedScene owned;
      std::vector<VehicleState> states;
      LocalPlan plan;
      owned.agents = crowd(12, 9.0, random);
      for (int i = 0; i < 8; ++i) {
        const LocalScene scene = owned.view(0.3 * i);
        planner->observe(scene);
        planner->plan(scene, goal, budget, plan);
        states.insert(states.end(), plan.states.begin(), plan.states.end());
        owned.robot = plan.at(plan.begin_s + 0.3);
        for (Agent& agent : owned.agents) agent.position += 0.3 * agent.velocity;
      }
      return states;
    };
    const std::vector<VehicleState> once = drive();
    const std::vector<VehicleState> again = drive();
    ASSERT_EQ(once.size(), again.size()) << vehicle.name;
    for (std::size_t i = 0; i < once.size(); ++i) {
      ASSERT_EQ(once[i].pose.x, again[i].pose.x) << vehicle.name;
      ASSERT_EQ(once[i].pose.y, again[i].pose.y) << vehicle.name;
      ASSERT_EQ(once[i].speed, again[i].speed) << vehicle.name;
    }
  }
}

/// Whether the outline touches one of the polygons: an independent judge, by points 10 cm apart.
inline bool touches(const Footprint& outline, const Pose2& pose,
                    const std::vector<Polygon>& polygons) {
  const double length = outline.front_m + outline.rear_m;
  const int along = static_cast<int>(length / 0.1) + 1;
  const int across = static_cast<int>(outline.width_m / 0.1) + 1;
  for (int i = 0; i <= along; ++i) {
    for (int j = 0; j <= across; ++j) {
      const Point2 p(-outline.rear_m + length * i / along,
                     outline.width_m * (static_cast<double>(j) / across - 0.5));
      for (const Polygon& polygon : polygons) {
        if (contains(polygon, pose * p)) return true;
      }
    }
  }
  return false;
}

/// Driven among random walls from a stand, by plans that follow each other every 0.3 s, the vehicle
/// touches none; nor does any plan.
inline void expect_no_plan_hits_obstacles(const MakePlanner& make, const PlanBudget& budget) {
  LocalPlan plan;
  for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
    for (int seed = 0; seed < 6; ++seed) {
      SCOPED_TRACE(vehicle.name + ", walls " + std::to_string(seed));
      RandomStream random(static_cast<std::uint64_t>(seed), "walls");
      std::vector<Polygon> walls;
      while (walls.size() < 7) {
        const double x = random.uniform(-10.0, 18.0);
        const double y = random.uniform(-9.0, 9.0);
        const Polygon wall = box(x, y, x + random.uniform(0.3, 4.0), y + random.uniform(0.3, 4.0));
        if (!touches({5.0, 3.0, 4.0}, {}, {wall})) walls.push_back(wall);
      }
      OwnedScene owned;
      owned.map = ClearanceMap::of(walls);
      owned.agents = crowd(4, 12.0, random);
      const std::unique_ptr<LocalPlanner> planner = make(vehicle);
      const LocalGoal goal{nullptr, 0.0, {16.0, random.uniform(-6.0, 6.0)}, 1.0, 1.4};
      for (int i = 0; i < 50; ++i) {
        const LocalScene scene = owned.view(0.3 * i);
        planner->observe(scene);
        planner->plan(scene, goal, budget, plan);
        ASSERT_TRUE(is_drivable(vehicle, scene, plan)) << "plan " << i;
        for (const VehicleState& state : plan.states) {
          ASSERT_FALSE(touches(vehicle.footprint, state.pose, walls))
              << "plan " << i << " of status " << static_cast<int>(plan.status) << " from ("
              << owned.robot.pose.x << ", " << owned.robot.pose.y << ") at " << owned.robot.speed
              << " m/s";
        }
        owned.robot = plan.states[std::min<std::size_t>(
            plan.states.size() - 1, static_cast<std::size_t>(std::lround(0.3 / plan.step_s)))];
        for (Agent& agent : owned.agents) agent.position += 0.3 * agent.velocity;
      }
    }
  }
}

inline void expect_planner_laws(const MakePlanner& make, const PlanBudget& budget = {}) {
  expect_plans_are_drivable(make, budget);
  expect_plans_repeat(make, budget);
  expect_no_plan_hits_obstacles(make, budget);
}

}  // namespace headland::test
