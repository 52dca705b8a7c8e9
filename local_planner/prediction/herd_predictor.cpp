// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/herd_predictor.hpp"

#include <cmath>

namespace headland {
namespace {

constexpr double kLongestStep = 0.2;  // of the motion [s]

bool is_animal(AgentKind kind) { return kind == AgentKind::kSheep || kind == AgentKind::kCattle; }

double reach_of(const HerdResponse& herd, AgentKind kind) {
  switch (kind) {
    case AgentKind::kDog:
      return herd.dog_reach_m;
    case AgentKind::kPerson:
      return herd.person_reach_m;
    default:
      return herd.robot_reach_m;
  }
}

}  // namespace

HerdPredictor::HerdPredictor(const HerdConfig& config) : config_(config), filter_(config.filter) {}

void HerdPredictor::observe(std::span<const Agent> agents, const Point2& robot, const Point2&,
                            double time_s) {
  filter_.observe(agents, time_s);
  const auto seen = filter_.seen();
  companion_velocities(config_.companions, seen, velocities_);
  if (robot.allFinite()) robot_ = robot;
  threats_now_.assign(1, {{robot_, {0.0, 0.0}}, config_.herd.robot_reach_m});
  animals_.clear();
  positions_.clear();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (is_animal(seen[i].kind)) {
      animals_.push_back(i);
      positions_.push_back(seen[i].position);
    } else {
      threats_now_.push_back(
          {{seen[i].position, velocities_[i]}, reach_of(config_.herd, seen[i].kind)});
    }
  }
  nearest_.find(positions_, config_.herd.neighbor_count, config_.herd.neighbor_m);
  accelerations_.clear();
  for (std::size_t i = 0; i < animals_.size(); ++i) {
    Point2 sum = seen[animals_[i]].acceleration;
    for (const int j : nearest_.of(i)) {
      sum += seen[animals_[static_cast<std::size_t>(j)]].acceleration;
    }
    accelerations_.push_back(sum / static_cast<double>(nearest_.of(i).size() + 1));
  }
}

HerdPredictor::Body HerdPredictor::mean_of_neighbors(std::size_t animal) const {
  Body mean = herd_[animal];
  const auto neighbors = nearest_.of(animal);
  for (const int j : neighbors) {
    mean.position += herd_[static_cast<std::size_t>(j)].position;
    mean.velocity += herd_[static_cast<std::size_t>(j)].velocity;
  }
  const double count = static_cast<double>(neighbors.size() + 1);
  return {mean.position / count, mean.velocity / count};
}

Point2 HerdPredictor::flight(const Body& body, double reach_ratio) const {
  constexpr double kTouching = 0.1;  // [m]
  constexpr double kFar = 20.0;      // in reaches
  Point2 sum(0.0, 0.0);
  for (const Threat& threat : threats_) {
    const double reach = reach_ratio * threat.reach;
    const Point2 away = body.position - threat.body.position;
    const double distance = away.norm();
    if (!(distance < kFar * reach)) continue;
    sum += std::exp(-distance / reach) / (distance + kTouching) * away;
  }
  return config_.herd.flight_mps2 * sum;
}

void HerdPredictor::step(double t, double dt) const {
  const HerdResponse& herd = config_.herd;
  const double persistence = std::exp(-t / herd.persistence_s);
  next_.clear();
  for (std::size_t i = 0; i < herd_.size(); ++i) {
    const Body mean = mean_of_neighbors(i);
    const bool is_cattle = filter_.seen()[animals_[i]].kind == AgentKind::kCattle;
    const Point2 acceleration =
        (mean.velocity - herd_[i].velocity) / herd.alignment_s +
        (mean.position - herd_[i].position) / (herd.cohesion_s * herd.cohesion_s) -
        mean.velocity / herd.slowing_s + persistence * accelerations_[i] +
        flight(herd_[i], is_cattle ? herd.cattle_reach_ratio : 1.0);
    const Point2 velocity = herd_[i].velocity + dt * acceleration;
    next_.push_back({herd_[i].position + dt * velocity, velocity});
  }
  std::swap(herd_, next_);
  for (Threat& threat : threats_) threat.body.position += dt * threat.body.velocity;
}

void HerdPredictor::predict(std::span<const Point2> robot_path, double step_s, int steps,
                            Prediction& prediction) const {
  const auto seen = filter_.seen();
  begin_prediction(seen, config_.spread, step_s, steps, prediction);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (is_animal(seen[i].kind)) continue;
    for (int k = 0; k < prediction.steps; ++k) {
      const double way = way_after(config_.companions, seen[i].kind, (k + 1) * step_s);
      prediction.mean[prediction.index(static_cast<int>(i), k)] =
          seen[i].position + way * velocities_[i];
    }
  }
  if (animals_.empty()) return;
  herd_.clear();
  for (const std::size_t i : animals_) herd_.push_back({seen[i].position, seen[i].velocity});
  threats_ = threats_now_;
  const int parts = static_cast<int>(std::ceil(step_s / kLongestStep));
  const double dt = step_s / parts;
  for (int k = 0; k < prediction.steps; ++k) {
    Threat& robot = threats_.front();
    const std::size_t on_path =
        std::min<std::size_t>(static_cast<std::size_t>(k), robot_path.size());
    robot.body.velocity.setZero();
    if (on_path < robot_path.size() && robot_path[on_path].allFinite()) {
      robot.body.velocity = (robot_path[on_path] - robot.body.position) / step_s;
    }
    for (int part = 0; part < parts; ++part) step(k * step_s + part * dt, dt);
    for (std::size_t i = 0; i < animals_.size(); ++i) {
      prediction.mean[prediction.index(static_cast<int>(animals_[i]), k)] = herd_[i].position;
    }
  }
}

}  // namespace headland
