// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/crowd/robot.hpp"

#include <cmath>

#include "sim/lab/crowd/scenario.hpp"

namespace headland {

using namespace crowd_protocol;

void HolonomicOrcaRobot::decide(double, std::span<const Agent> agents) {
  lines_.clear();
  for (const Agent& agent : agents) {
    const double reach = kRadius + agent.radius_m + 2.0 * kOrcaMargin;
    lines_.push_back(orca_line(position_, velocity_, {agent.position, agent.velocity, reach},
                               kOrcaHorizon, kStep));
  }
  const Point2 to_goal = goal_ - position_;
  const Point2 preferred = kSpeed / std::max(kSpeed, to_goal.norm()) * to_goal;
  velocity_ = permitted_velocity(lines_, 0, preferred, kSpeed, scratch_);
}

void HolonomicOrcaRobot::move(double, double dt) { position_ += dt * velocity_; }

PlannedRobot::PlannedRobot(const Vehicle& vehicle, std::unique_ptr<LocalPlanner> planner,
                           const PlanBudget& budget, const Point2& start, const Point2& goal)
    : vehicle_(vehicle), planner_(std::move(planner)), budget_(budget) {
  goal_.place = goal;
  goal_.accuracy_m = kGoal;
  goal_.speed_mps = kSpeed;
  const Point2 ahead = goal - start;
  state_.pose = {start.x(), start.y(), std::atan2(ahead.y(), ahead.x())};
}

Point2 PlannedRobot::velocity() const {
  return state_.speed * Point2(std::cos(state_.pose.yaw), std::sin(state_.pose.yaw));
}

void PlannedRobot::decide(double time_s, std::span<const Agent> agents) {
  const LocalScene scene{time_s, state_, agents};
  planner_->observe(scene);
  planner_->plan(scene, goal_, budget_, plan_);
}

void PlannedRobot::move(double time_s, double dt) {
  const VehicleState next = plan_.at(time_s + dt);
  state_ = step_vehicle(vehicle_, state_, {next.speed, next.steering, next.yaw_rate}, dt);
}

}  // namespace headland
