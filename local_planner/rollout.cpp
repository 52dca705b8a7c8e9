// SPDX-License-Identifier: Apache-2.0
#include "local_planner/rollout.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kLateralAcceleration = 1.0;  // [m/s2]

// The yaw rate that leaves each wheel of a differential vehicle within the speed it can have.
double yaw_rate_within(const Vehicle& vehicle, double yaw_rate, double speed) {
  const double top = std::max(vehicle.work_speed_mps, vehicle.transit_speed_mps);
  const double most = std::max(0.0, 2.0 * (top - std::abs(speed)) / vehicle.track_width_m);
  return std::clamp(yaw_rate, -most, most);
}

}  // namespace

double speed_within(const Vehicle& vehicle, double wanted, Gear gear, double curvature) {
  double top = std::max(vehicle.work_speed_mps, vehicle.transit_speed_mps);
  if (gear == Gear::kReverse && vehicle.reverse_speed_mps > 0.0) {
    top = std::min(top, vehicle.reverse_speed_mps);
  }
  const double in_curve = std::sqrt(kLateralAcceleration / std::max(1e-6, std::abs(curvature)));
  return std::min({wanted, top, in_curve});
}

Command command_for(const Vehicle& vehicle, const VehicleState& state, const Motion& motion,
                    double step) {
  const double most = vehicle.acceleration_mps2 * step;
  const double speed = state.speed + std::clamp(motion.speed - state.speed, -most, most);
  Command command;
  command.speed = command_through_lag(speed, state.speed, vehicle.speed_lag_s, step);
  if (vehicle.steering == Steering::kAckermann) {
    const double limit = vehicle.max_steering_rad();
    const double angle =
        std::clamp(std::atan(vehicle.wheelbase_m * motion.curvature), -limit, limit);
    command.steering = command_through_lag(angle, state.steering, vehicle.steering_lag_s, step);
  } else {
    const double mean = 0.5 * (state.speed + speed);
    const double rate = yaw_rate_within(vehicle, motion.curvature * mean + motion.pivot, speed);
    command.yaw_rate = command_through_lag(rate, state.yaw_rate, vehicle.steering_lag_s, step);
  }
  return command;
}

Command command_along(const Vehicle& vehicle, const VehicleState& state, const LocalPlan& plan,
                      double time, double cycle) {
  const VehicleState next = plan.at(time + cycle);
  if (vehicle.steering == Steering::kAckermann) {
    const double curvature = std::tan(next.steering) / vehicle.wheelbase_m;
    return command_for(vehicle, state, {next.speed, curvature, 0.0}, cycle);
  }
  const bool drives = std::abs(next.speed) > 1e-3;
  return command_for(
      vehicle, state,
      {next.speed, drives ? next.yaw_rate / next.speed : 0.0, drives ? 0.0 : next.yaw_rate}, cycle);
}

void begin_plan(const LocalScene& scene, double step, LocalPlan& plan) {
  plan.status = LocalStatus::kPlanned;
  plan.begin_s = scene.time_s;
  plan.step_s = step;
  plan.states.assign(1, scene.robot.state);
}

void drive_on(const Vehicle& vehicle, const Motion& motion, LocalPlan& plan) {
  const VehicleState& now = plan.states.back();
  plan.states.push_back(
      step_vehicle(vehicle, now, command_for(vehicle, now, motion, plan.step_s), plan.step_s));
}

bool stays_clear(const Vehicle& vehicle, const OutlineDiscs& outline, const ClearanceMap* map,
                 const LocalPlan& plan, double commit, LocalPlan& scratch) {
  if (map == nullptr || map->empty()) return true;
  const double least = std::min(0.0, outline.free(*map, plan.states.front().pose));
  const auto clear = [&](const VehicleState& state) {
    return outline.free(*map, state.pose) >= least;
  };
  if (!std::all_of(plan.states.begin() + 1, plan.states.end(), clear)) return false;
  brake(vehicle, plan.at(plan.begin_s + commit), plan.begin_s + commit, LocalStatus::kBraking,
        scratch);
  return std::all_of(scratch.states.begin(), scratch.states.end(), clear);
}

Approach nearest_approach(const Footprint& outline, const LocalScene& scene,
                          const LocalPlan& plan) {
  Approach nearest;
  for (std::size_t i = 0; i < plan.states.size(); ++i) {
    const Pose2 T_base_map = inverse(plan.states[i].pose);
    const double time = plan.step_s * static_cast<double>(i);
    const double age = std::max(0.0, scene.age_s) + plan.begin_s - scene.time_s + time;
    for (std::size_t a = 0; a < scene.agents.size(); ++a) {
      const Agent& agent = scene.agents[a];
      const Point2 there = agent.position + age * agent.velocity;
      const double gap = outline_distance(outline, T_base_map * there) - agent.radius_m;
      if (gap < nearest.gap) nearest = {gap, time, static_cast<int>(a)};
    }
  }
  return nearest;
}

}  // namespace headland
