// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/orca_predictor.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kLongestStep = 0.5;  // of the motion [s]

}  // namespace

OrcaPredictor::OrcaPredictor(const OrcaConfig& config) : config_(config), filter_(config.filter) {
  const auto most = static_cast<std::size_t>(std::max(0, config.avoidance.neighbor_count)) + 1;
  lines_.reserve(most);
  program_.reserve(most);
}

void OrcaPredictor::observe(std::span<const Agent> agents, const Point2& robot, const Point2&,
                            double time_s) {
  filter_.observe(agents, time_s);
  companion_velocities(config_.companions, filter_.seen(), velocities_);
  if (robot.allFinite()) robot_ = robot;
  positions_.clear();
  for (const FilteredAgent& agent : filter_.seen()) positions_.push_back(agent.position);
  nearest_.find(positions_, config_.avoidance.neighbor_count, config_.avoidance.neighbor_m);
}

double OrcaPredictor::kept_distance(std::size_t a, std::size_t b) const {
  const auto seen = filter_.seen();
  return std::min(seen[a].radius_m + seen[b].radius_m, (positions_[a] - positions_[b]).norm());
}

Point2 OrcaPredictor::avoiding_velocity(std::size_t self, const Body& robot,
                                        const Point2& preferred, double dt) const {
  const Avoidance& avoidance = config_.avoidance;
  const Body& body = bodies_[self];
  lines_.clear();
  if (avoidance.robot_share_ratio > 0.0) {
    const double reach = filter_.seen()[self].radius_m + avoidance.robot_radius_m;
    lines_.push_back(orca_line(body.position, body.velocity,
                               {robot.position, robot.velocity, reach, avoidance.robot_share_ratio},
                               avoidance.horizon_s, dt));
  }
  for (const int j : nearest_.of(self)) {
    const auto other = static_cast<std::size_t>(j);
    lines_.push_back(orca_line(
        body.position, body.velocity,
        {bodies_[other].position, bodies_[other].velocity, kept_distance(self, other), 0.5},
        avoidance.horizon_s, dt));
  }
  const double max_speed = std::max(avoidance.max_speed_mps, preferred.norm());
  return permitted_velocity(lines_, 0, preferred, max_speed, program_);
}

void OrcaPredictor::predict(std::span<const Point2> robot_path, double step_s, int steps,
                            Prediction& prediction) const {
  const auto seen = filter_.seen();
  begin_prediction(seen, config_.spread, step_s, steps, prediction);
  if (prediction.steps == 0) return;
  bodies_.clear();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    bodies_.push_back({seen[i].position, velocities_[i]});
  }
  const int parts = static_cast<int>(std::ceil(step_s / kLongestStep));
  const double dt = step_s / parts;
  Body robot{robot_, {0.0, 0.0}};
  for (int k = 0; k < prediction.steps; ++k) {
    const auto next = static_cast<std::size_t>(k);
    robot.velocity.setZero();
    if (next < robot_path.size() && robot_path[next].allFinite()) {
      robot.velocity = (robot_path[next] - robot.position) / step_s;
    }
    for (int part = 0; part < parts; ++part) {
      const double t = k * step_s + part * dt;
      next_.clear();
      for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const double pace = (way_after(config_.companions, seen[i].kind, t + dt) -
                             way_after(config_.companions, seen[i].kind, t)) /
                            dt;
        const Point2 velocity = avoiding_velocity(i, robot, pace * velocities_[i], dt);
        next_.push_back({bodies_[i].position + dt * velocity, velocity});
      }
      std::swap(bodies_, next_);
      robot.position += dt * robot.velocity;
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      prediction.mean[prediction.index(static_cast<int>(i), k)] = bodies_[i].position;
    }
  }
}

}  // namespace headland
