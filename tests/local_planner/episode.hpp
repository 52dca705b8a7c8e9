// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "local_planner/fail_safe/fail_safe.hpp"
#include "local_planner/local_planner.hpp"
#include "local_planner/rollout.hpp"

namespace headland::test {

/// Someone who walks a script: straight at `velocity` between two moments, standing otherwise.
struct Walker {
  Point2 start{0.0, 0.0};
  Point2 velocity{0.0, 0.0};  // [m/s]
  double from = 0.0;          // [s]
  double until = 1e9;         // [s]
  double radius = 0.3;

  Agent at(double time) const {
    Agent agent;
    const double walked = std::clamp(time, from, until) - from;
    agent.position = start + walked * velocity;
    if (time >= from && time < until) agent.velocity = velocity;
    agent.radius_m = radius;
    return agent;
  }
};

/// What came of a drive.
struct Episode {
  bool reached = false;
  double duration = 0.0;       ///< [s]
  double least_gap = 1e3;      ///< outline to disc [m]
  double hardest_hit = 0.0;    ///< fastest speed of the robot while somebody touched it [m/s]
  double longest_stand = 0.0;  ///< [s]
  double farthest_off = 0.0;   ///< from the path [m]
  double driven = 0.0;         ///< [m]
  VehicleState end;
};

/// Drives a vehicle along a path until its place is reached or `limit` [s] is over. Plans every
/// 0.3 s, follows them every 0.05 s, with the fail-safe beneath if there is one.
inline Episode drive(const Vehicle& vehicle, LocalPlanner& planner, FailSafe* fail_safe,
                     LocalGoal goal, const std::vector<Walker>& walkers,
                     const ClearanceMap* map = nullptr, double limit = 60.0,
                     VehicleState robot = {}) {
  constexpr double kCycle = 0.05;
  constexpr int kCyclesPerPlan = 6;
  Episode episode;
  LocalPlan plan;
  std::vector<Agent> agents(walkers.size());
  double stands = 0.0;
  for (int i = 0; kCycle * i < limit; ++i) {
    const double time = kCycle * i;
    std::transform(walkers.begin(), walkers.end(), agents.begin(),
                   [time](const Walker& walker) { return walker.at(time); });
    const LocalScene scene{time, robot, agents, map, 0.0};
    if (goal.path != nullptr) {
      const Projection nearest = goal.path->project(robot.pose.position(), goal.s, goal.s + 1.0);
      goal.s = nearest.s;
      episode.farthest_off = std::max(episode.farthest_off, nearest.distance);
    }
    if (i % kCyclesPerPlan == 0) {
      planner.observe(scene);
      planner.plan(scene, goal, {300, {}}, plan);
    }
    Command command = command_along(vehicle, robot, plan, time, kCycle);
    if (fail_safe != nullptr) command = fail_safe->limit(scene, command).command;
    robot = step_vehicle(vehicle, robot, command, kCycle);
    episode.driven += std::abs(robot.speed) * kCycle;
    for (const Walker& walker : walkers) {
      const Agent agent = walker.at(time + kCycle);
      const double gap = outline_distance(vehicle.footprint, inverse(robot.pose) * agent.position) -
                         agent.radius_m;
      episode.least_gap = std::min(episode.least_gap, gap);
      if (gap <= 0.0) episode.hardest_hit = std::max(episode.hardest_hit, std::abs(robot.speed));
    }
    stands = std::abs(robot.speed) < 0.03 ? stands + kCycle : 0.0;
    episode.longest_stand = std::max(episode.longest_stand, stands);
    episode.duration = time + kCycle;
    if ((robot.pose.position() - goal.place).norm() <= goal.accuracy_m) {
      episode.reached = true;
      break;
    }
  }
  episode.end = robot;
  return episode;
}

}  // namespace headland::test
