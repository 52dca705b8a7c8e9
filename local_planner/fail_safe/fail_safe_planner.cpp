// SPDX-License-Identifier: Apache-2.0
#include "local_planner/fail_safe/fail_safe_planner.hpp"

#include <algorithm>
#include <cmath>

#include "local_planner/course.hpp"

namespace headland {
namespace {

constexpr double kStep = 0.1;        // of plans [s]
constexpr double kCommit = 0.5;      // what is driven before the next plan can stop it [s]
constexpr double kBeforeWall = 0.1;  // stops so far from where the outline would touch [m]

}  // namespace

FailSafePlanner::FailSafePlanner(const Vehicle& vehicle, const FailSafePlannerConfig& config)
    : LocalPlanner(vehicle),
      config_(config),
      fail_safe_(vehicle, config.fail_safe),
      discs_(vehicle.footprint) {}

// Rolls the pursuit of the path out, at most at `speed`, so as to stand after `way` [m]; returns
// the way to the first state that is nearer to an obstacle than the outline may be.
double FailSafePlanner::follow(const LocalScene& scene, const LocalGoal& goal, double speed,
                               double way, LocalPlan& plan) const {
  begin_plan(scene, kStep, plan);
  Course course(goal);
  double driven = 0.0;
  double free_way = 1e9;
  const bool has_map = scene.map != nullptr && !scene.map->empty();
  const double least =
      has_map ? std::min(0.0, discs_.free(*scene.map, scene.robot.state.pose)) : 0.0;
  const int steps = static_cast<int>(std::ceil(config_.horizon_s / kStep));
  for (int i = 0; i < steps; ++i) {
    const VehicleState& now = plan.states.back();
    const double lookahead = config_.lookahead_m + config_.lookahead_time_s * std::abs(now.speed);
    Aim aim = course.from(now, lookahead);
    aim.left = std::min(aim.left, way - driven);
    const Motion motion = pursue(vehicle(), now, aim, speed);
    drive_on(vehicle(), motion, plan);
    driven += 0.5 * std::abs(now.speed + plan.states.back().speed) * kStep;
    if (has_map && discs_.free(*scene.map, plan.states.back().pose) < least) {
      free_way = std::min(free_way, driven);
    }
  }
  return free_way;
}

void FailSafePlanner::do_plan(const LocalScene& scene, const LocalGoal& goal, const PlanBudget&,
                              LocalPlan& plan) {
  const VehicleState& state = scene.robot.state;
  const double free_way = follow(scene, goal, goal.speed_mps, 1e9, plan);
  const Command wanted = command_along(vehicle(), state, plan, scene.time_s, kCommit);
  const SafeCommand safe = fail_safe_.limit(scene, wanted);
  const bool turns = std::abs(wanted.speed) < Stopping::kStill;  // on the spot
  const double speed = safe.reason == SafetyReason::kNone ? goal.speed_mps
                       : turns                            ? 0.0
                                                          : safe.allowed_speed;
  if (speed < goal.speed_mps || free_way < 1e9) {
    follow(scene, goal, speed, free_way - kBeforeWall, plan);
  }
  plan.expansions = static_cast<int>(plan.states.size());
  const bool stands = std::abs(state.speed) < Stopping::kStill;
  const bool stays = speed < Stopping::kStill || free_way < kBeforeWall;
  if (stays || !stays_clear(vehicle(), discs_, scene.map, plan, kCommit, scratch_)) {
    brake(vehicle(), state, scene.time_s, stands ? LocalStatus::kBlocked : LocalStatus::kBraking,
          plan);
  }
}

}  // namespace headland
