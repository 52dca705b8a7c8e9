// SPDX-License-Identifier: Apache-2.0
#include "local_planner/local_planner.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kStandsAfter = 1.0;      // a braking plan goes on for so long at a stand [s]
constexpr double kLongestBraking = 60.0;  // [s]

}  // namespace

VehicleState LocalPlan::at(double time_s) const {
  const double steps = (time_s - begin_s) / step_s;
  if (!(steps > 0.0)) return states.front();
  const auto i = static_cast<std::size_t>(steps);
  if (i + 1 >= states.size()) return states.back();
  const VehicleState& a = states[i];
  const VehicleState& b = states[i + 1];
  const double ratio = steps - static_cast<double>(i);
  const auto mix = [ratio](double from, double to) { return from + ratio * (to - from); };
  return {{mix(a.pose.x, b.pose.x), mix(a.pose.y, b.pose.y),
           a.pose.yaw + ratio * wrap_angle(b.pose.yaw - a.pose.yaw)},
          mix(a.speed, b.speed),
          mix(a.steering, b.steering),
          mix(a.yaw_rate, b.yaw_rate)};
}

void LocalPlanner::plan(const LocalScene& scene, const LocalGoal& goal, const PlanBudget& budget,
                        LocalPlan& plan) {
  if (!is_finite(scene, goal) || !(goal.speed_mps > 0.0)) {
    brake(vehicle_, scene.robot.state, scene.time_s, LocalStatus::kBadInput, plan);
  } else if (!(scene.age_s <= kOldestScene)) {
    brake(vehicle_, scene.robot.state, scene.time_s, LocalStatus::kStale, plan);
  } else {
    plan.expansions = 0;
    plan.cost = 0.0;
    do_plan(scene, goal, budget, plan);
  }
}

void brake(const Vehicle& vehicle, const VehicleState& state, double time_s, LocalStatus status,
           LocalPlan& plan) {
  plan.status = status;
  plan.begin_s = std::isfinite(time_s) ? time_s : 0.0;
  plan.step_s = 0.1;
  plan.expansions = 0;
  plan.cost = 0.0;
  plan.states.clear();
  // A state that is no number has no way on: the plan stands where it is.
  VehicleState now = is_finite(state) ? state : VehicleState{};
  const double until_still = std::abs(now.speed) / vehicle.acceleration_mps2 + vehicle.speed_lag_s;
  const double duration = std::min(until_still, kLongestBraking) + kStandsAfter;
  plan.states.push_back(now);
  for (int i = 0; i < static_cast<int>(std::ceil(duration / plan.step_s)); ++i) {
    // The yaw rate follows the curve: it falls with the speed.
    const double speed = step_speed(vehicle, now.speed, 0.0, plan.step_s);
    const double yaw_rate = std::abs(now.speed) > 1e-6 ? now.yaw_rate * speed / now.speed : 0.0;
    now = step_vehicle(vehicle, now, {0.0, now.steering, yaw_rate}, plan.step_s);
    plan.states.push_back(now);
  }
}

bool is_finite(const Agent& agent) {
  return agent.position.allFinite() && agent.velocity.allFinite() &&
         std::isfinite(agent.radius_m) && std::isfinite(agent.noise_m);
}

bool is_finite(const LocalScene& scene, const LocalGoal& goal) {
  return std::all_of(scene.agents.begin(), scene.agents.end(),
                     [](const Agent& agent) { return is_finite(agent); }) &&
         is_finite(scene.robot.state) && std::isfinite(scene.time_s) && goal.place.allFinite() &&
         std::isfinite(goal.accuracy_m) && std::isfinite(goal.speed_mps) && std::isfinite(goal.s) &&
         !std::isnan(scene.age_s);
}

}  // namespace headland
