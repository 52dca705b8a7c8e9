// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/learned_predictor.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace headland {
namespace {

using Eigen::Index;
using Vector = Eigen::Vector2f;

constexpr double kForgotten = 1.0;     // agents not seen for so long [s]
constexpr double kStanding = 0.05;     // slower, an agent has no heading [m/s]
constexpr double kFastest = 30.0;      // nobody is faster; sights that say so are cut [m/s]
constexpr float kFarAway = 1e6F;       // where a robot is that nobody knows of [m]
constexpr float kSmallestLog = -6.0F;  // of what a deviation grows by per step [log m]
constexpr float kLargestLog = 1.5F;
constexpr float kMostCorrelated = 0.95F;

Point2 cut(const Point2& velocity) {
  const double speed = velocity.norm();
  return speed > kFastest ? Point2(kFastest / speed * velocity) : velocity;
}

bool is_usable(const Agent& agent, const Point2& origin) {
  return (agent.position - origin).cast<float>().allFinite() && agent.velocity.allFinite() &&
         std::isfinite(agent.radius_m) && std::isfinite(agent.noise_m);
}

// The robot on its planned positions, which are `step` apart, the first one step from `begin`;
// it stays at the last one that is a number.
Point2 along(std::span<const Point2> path, const Point2& begin, double step, double time) {
  const double steps = time / step;
  Point2 before = begin;
  for (std::size_t i = 0; i < path.size() && path[i].allFinite(); ++i) {
    const double ratio = steps - static_cast<double>(i);
    if (ratio <= 1.0) return before + ratio * (path[i] - before);
    before = path[i];
  }
  return before;
}

Eigen::Matrix2f growth(const Eigen::Ref<const Eigen::VectorXf>& output, const Vector& heading) {
  const float a = std::exp(std::clamp(output(2), kSmallestLog, kLargestLog));
  const float b = std::exp(std::clamp(output(3), kSmallestLog, kLargestLog));
  const float ab = a * b * kMostCorrelated * std::tanh(output(4));
  Eigen::Matrix2f local;
  local << a * a, ab, ab, b * b;
  Eigen::Matrix2f turn;
  turn << heading.x(), -heading.y(), heading.y(), heading.x();
  Eigen::Matrix2f grown = turn * local * turn.transpose();
  grown(1, 0) = grown(0, 1);  // to the last bit
  return grown;
}

}  // namespace

LearnedPredictor::LearnedPredictor(ResponseNetwork network, double robot_radius)
    : network_(std::move(network)), robot_radius_m_(robot_radius) {
  if (!(robot_radius >= 0.0 && std::isfinite(robot_radius))) {
    throw std::invalid_argument(fmt::format("robot radius {} m, must be >= 0", robot_radius));
  }
}

void LearnedPredictor::forget(double time_s) {
  if (time_s < time_s_) {  // another run begins
    tracks_.clear();
    robot_.clear();
  }
  std::erase_if(tracks_, [&](const Track& track) {
    return track.history.newest().time_s < time_s - kForgotten;
  });
  if (!robot_.empty() && robot_.newest().time_s < time_s - kForgotten) robot_.clear();
  time_s_ = time_s;
}

// Sights without a velocity get that of the way since one step before.
void LearnedPredictor::remember(const Agent& agent, double time_s) {
  auto found = std::find_if(tracks_.begin(), tracks_.end(),
                            [&](const Track& track) { return track.id == agent.id; });
  const auto place = static_cast<std::size_t>(found - tracks_.begin());
  if (std::find(seen_.begin(), seen_.end(), place) != seen_.end()) return;
  if (found == tracks_.end()) {
    tracks_.emplace_back();
    found = std::prev(tracks_.end());
  }
  seen_.push_back(place);
  found->id = agent.id;
  found->radius_m = std::max(0.0, agent.radius_m);
  found->noise_m = std::max(0.0, agent.noise_m);
  SightHistory::Sight sight{time_s, agent.position, cut(agent.velocity)};
  if (agent.velocity.isZero(0.0) && !found->history.empty()) {
    SightHistory::Sight before = found->history.oldest();
    found->history.at(time_s - network_.step_s, before);
    const double passed = time_s - before.time_s;
    if (passed > 0.0) sight.velocity = cut((sight.position - before.position) / passed);
  }
  found->history.add(sight);
}

// Members and moment of the last sight.
void LearnedPredictor::look(const Point2& robot) {
  origin_ = robot;
  members_.clear();
  now_.position.clear();
  now_.velocity.clear();
  now_.present.assign(seen_.size(), 1);
  for (const std::size_t place : seen_) {
    const Track& track = tracks_[place];
    const SightHistory::Sight& sight = track.history.newest();
    const double speed = sight.velocity.norm();
    const Point2 heading = speed > kStanding ? Point2(sight.velocity / speed) : Point2(1.0, 0.0);
    members_.push_back({heading.cast<float>(), static_cast<float>(track.radius_m),
                        static_cast<float>(track.noise_m)});
    now_.position.push_back((sight.position - origin_).cast<float>());
    now_.velocity.push_back(sight.velocity.cast<float>());
  }
}

// Where all were at a time; the robot's velocity is that of the step that began then.
void LearnedPredictor::look_back(double time_s) {
  CrowdMoment& moment = rollout_.moment;
  moment = now_;
  SightHistory::Sight sight;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    moment.present[i] = tracks_[seen_[i]].history.at(time_s, sight);
    if (!moment.present[i]) continue;
    moment.position[i] = (sight.position - origin_).cast<float>();
    moment.velocity[i] = sight.velocity.cast<float>();
  }
  moment.robot.setConstant(kFarAway);
  moment.robot_velocity.setZero();
  SightHistory::Sight next;
  if (robot_.at(time_s, sight) && robot_.at(time_s + network_.step_s, next)) {
    moment.robot = (sight.position - origin_).cast<float>();
    moment.robot_velocity = cut((next.position - sight.position) / network_.step_s).cast<float>();
  }
}

void LearnedPredictor::encode() {
  const auto agents = static_cast<Index>(seen_.size());
  const Index hidden = network_.encoder.hidden();
  encoded_.reset(network_.encoder.inputs(), hidden, agents);
  for (int k = network_.past_steps; k > 0; --k) {
    look_back(time_s_ - k * network_.step_s);
    const CrowdMoment& moment = rollout_.moment;
    rollout_.inputs.compute(network_, members_, moment, static_cast<float>(robot_radius_m_),
                            encoded_.stacked);
    network_.encoder.step(agents, encoded_);
    for (Index i = 0; i < agents; ++i) {  // who has not been seen by then remembers nothing
      if (moment.present[static_cast<std::size_t>(i)]) continue;
      encoded_.stacked.col(i).setZero();
      encoded_.cell.col(i).setZero();
    }
  }
}

void LearnedPredictor::observe(std::span<const Agent> agents, const Point2& robot,
                               const Point2& robot_velocity, double time_s) {
  if (!std::isfinite(time_s)) return;
  forget(time_s);
  seen_.clear();
  const bool robot_known = robot.allFinite() && robot_velocity.allFinite();
  if (robot_known) robot_.add({time_s, robot, robot_velocity});
  Point2 origin = robot;
  for (const Agent& agent : agents) {
    if (!origin.allFinite()) origin = agent.position;
    if (is_usable(agent, origin)) remember(agent, time_s);
  }
  look(origin);
  encode();
}

// One step of the decoder for all agents.
void LearnedPredictor::move_on(std::size_t step) const {
  CrowdMoment& moment = rollout_.moment;
  const auto agents = static_cast<Index>(members_.size());
  const Index hidden = network_.decoder.hidden();
  rollout_.inputs.compute(network_, members_, moment, static_cast<float>(robot_radius_m_),
                          rollout_.batch.stacked);
  network_.decoder.step(agents, rollout_.batch);
  auto outputs = rollout_.outputs.leftCols(agents);
  outputs.noalias() =
      network_.head.weight * rollout_.batch.stacked.bottomRows(hidden).leftCols(agents);
  outputs.colwise() += network_.head.bias;
  const auto dt = static_cast<float>(network_.step_s);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const auto output = outputs.col(static_cast<Index>(i));
    const Vector& heading = members_[i].heading;
    moment.velocity[i] += output(0) * heading + output(1) * Vector(-heading.y(), heading.x());
    moment.position[i] += dt * moment.velocity[i];
    const std::size_t before = step * members_.size() + i;
    rollout_.mean[before + members_.size()] = moment.position[i];
    rollout_.covariance[before + members_.size()] =
        rollout_.covariance[before] + growth(output, heading);
  }
}

void LearnedPredictor::predict(std::span<const Point2> robot_path, double step_s, int steps,
                               Prediction& prediction) const {
  const bool sound = std::isfinite(step_s) && step_s > 0.0 && steps > 0;
  const int wanted = sound ? steps : 0;
  const double dt = network_.step_s;
  const auto network_steps =
      static_cast<std::size_t>(sound ? std::ceil(std::max(1.0, wanted * step_s / dt - 1e-9)) : 0.0);
  const std::size_t agents = members_.size();
  rollout_.moment = now_;
  rollout_.batch = encoded_;
  make_room(rollout_.outputs, kHeadOutputs, static_cast<Index>(agents));
  rollout_.mean.resize((network_steps + 1) * agents);
  rollout_.covariance.resize((network_steps + 1) * agents);
  for (std::size_t i = 0; i < agents; ++i) {
    rollout_.mean[i] = now_.position[i];
    rollout_.covariance[i] = members_[i].noise * members_[i].noise * Eigen::Matrix2f::Identity();
  }
  for (std::size_t k = 0; k < network_steps && agents > 0; ++k) {
    rollout_.moment.robot.setConstant(kFarAway);
    rollout_.moment.robot_velocity.setZero();
    if (!robot_.empty() && robot_.newest().time_s == time_s_) {
      const Point2& begin = robot_.newest().position;
      const double t = static_cast<double>(k) * dt;
      const Point2 from = along(robot_path, begin, step_s, t);
      const Point2 to = along(robot_path, begin, step_s, t + dt);
      rollout_.moment.robot = (from - origin_).cast<float>();
      rollout_.moment.robot_velocity = cut((to - from) / dt).cast<float>();
    }
    move_on(k);
  }
  resample(step_s, wanted, prediction);
}

// From the network's steps to those that are wanted, linear in between.
void LearnedPredictor::resample(double step_s, int steps, Prediction& prediction) const {
  const std::size_t agents = members_.size();
  const auto count = static_cast<std::size_t>(steps);
  prediction.step_s = step_s;
  prediction.steps = steps;
  prediction.ids.clear();
  prediction.radius_m.clear();
  prediction.mean.resize(agents * count);
  prediction.covariance.resize(agents * count);
  for (std::size_t i = 0; i < agents; ++i) {
    prediction.ids.push_back(tracks_[seen_[i]].id);
    prediction.radius_m.push_back(tracks_[seen_[i]].radius_m);
    for (std::size_t s = 0; s < count; ++s) {
      const double at = static_cast<double>(s + 1) * step_s / network_.step_s;
      const auto after = static_cast<std::size_t>(std::ceil(std::max(1.0, at - 1e-9)));
      const double ratio = 1.0 + std::min(0.0, at - static_cast<double>(after));
      const std::size_t b = after * agents + i;
      const std::size_t a = b - agents;
      prediction.mean[i * count + s] = origin_ + (1.0 - ratio) * rollout_.mean[a].cast<double>() +
                                       ratio * rollout_.mean[b].cast<double>();
      prediction.covariance[i * count + s] = (1.0 - ratio) * rollout_.covariance[a].cast<double>() +
                                             ratio * rollout_.covariance[b].cast<double>();
    }
  }
}

}  // namespace headland
