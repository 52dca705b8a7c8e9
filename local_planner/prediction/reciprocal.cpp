// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/reciprocal.hpp"

#include <algorithm>
#include <cmath>

namespace headland {

void ReciprocalPredictor::observe(std::span<const Agent> agents, const Point2& robot, const Point2&,
                                  double time_s) {
  filter_.observe(agents, time_s);
  robot_ = robot;
}

// The nearest now stay the ones that are looked at: the horizon is short.
void ReciprocalPredictor::find_neighbors() const {
  std::vector<std::pair<double, int>> near;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    body.neighbors.clear();
    if (!body.reacts) continue;
    near.clear();
    const double reach = 2.0 * config_.max_speed_mps * config_.horizon_s;
    for (std::size_t j = 0; j < bodies_.size(); ++j) {
      const double distance = (bodies_[j].position - body.position).squaredNorm();
      if (j != i && distance < reach * reach) near.emplace_back(distance, static_cast<int>(j));
    }
    const auto most = static_cast<std::ptrdiff_t>(
        std::min(near.size(), static_cast<std::size_t>(config_.neighbors_count)));
    std::partial_sort(near.begin(), near.begin() + most, near.end());
    for (std::ptrdiff_t k = 0; k < most; ++k) {
      body.neighbors.push_back(near[static_cast<std::size_t>(k)].second);
    }
  }
}

void ReciprocalPredictor::step(const OrcaNeighbor& robot, double dt) const {
  std::size_t i = 0;
  for (Body& body : bodies_) {
    const Point2 preferred = filter_.agents()[i++].agent.velocity;
    body.next = preferred;
    if (!body.reacts) continue;
    lines_.clear();
    OrcaNeighbor seen = robot;
    seen.reach_m = config_.robot_radius_m + body.radius;
    lines_.push_back(orca_line(body.position, body.velocity, seen, config_.horizon_s, dt));
    for (const int n : body.neighbors) {
      const Body& other = bodies_[static_cast<std::size_t>(n)];
      lines_.push_back(orca_line(body.position, body.velocity,
                                 {other.position, other.velocity, body.radius + other.radius, 0.5},
                                 config_.horizon_s, dt));
    }
    const double fastest = std::max(config_.max_speed_mps, preferred.norm());
    body.next = permitted_velocity(lines_, 0, preferred, fastest, scratch_);
  }
  for (Body& body : bodies_) {
    body.velocity = body.next;
    body.position += dt * body.velocity;
  }
}

void ReciprocalPredictor::predict(std::span<const Point2> robot_path, double step_s, int steps,
                                  Prediction& prediction) const {
  prediction.begin(step_s, steps);
  const auto agents = filter_.agents();
  bodies_.resize(agents.size());
  for (std::size_t i = 0; i < agents.size(); ++i) {
    const Agent& agent = agents[i].agent;
    bodies_[i].position = agent.position;
    bodies_[i].velocity = agent.velocity;
    bodies_[i].radius = agent.radius_m;
    bodies_[i].reacts = (agent.position - robot_).norm() < config_.range_m;
    prediction.ids.push_back(agent.id);
    prediction.radius_m.push_back(agent.radius_m);
  }
  prediction.mean.resize(agents.size() * static_cast<std::size_t>(steps));
  prediction.covariance.resize(prediction.mean.size());
  find_neighbors();
  OrcaNeighbor robot;
  robot.position = robot_;
  robot.share = config_.robot_share_ratio;
  for (int k = 0; k < steps; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const Point2 next = robot_path.empty()       ? robot.position
                        : at < robot_path.size() ? robot_path[at]
                                                 : robot_path.back();
    robot.velocity = (next - robot.position) / step_s;
    step(robot, step_s);
    robot.position = next;
    for (std::size_t i = 0; i < agents.size(); ++i) {
      const std::size_t cell = prediction.index(static_cast<int>(i), k);
      prediction.mean[cell] = bodies_[i].position;
      prediction.covariance[cell] =
          agents[i].variance_at((k + 1) * step_s, config_.filter.acceleration_density) *
          Eigen::Matrix2d::Identity();
    }
  }
}

}  // namespace headland
