// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/agent_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace headland {
namespace {

constexpr double kForgetAfter = 1.0;     // [s]
constexpr double kFastest = 15.0;        // nobody on a farm is faster [m/s]
constexpr double kFarthest = 1e7;        // [m]
constexpr double kSettled = 0.5;         // until then accelerations are the filter's own [s]
constexpr double kSeenSpeedNoise = 0.5;  // of an observed velocity, per axis [m/s]

bool is_usable(const Agent& agent) {
  return agent.position.allFinite() && agent.velocity.allFinite() &&
         agent.position.cwiseAbs().maxCoeff() < kFarthest && std::isfinite(agent.radius_m) &&
         std::isfinite(agent.noise_m);
}

}  // namespace

double VelocityWalk::of(AgentKind kind) const {
  switch (kind) {
    case AgentKind::kSheep:
      return sheep_mps;
    case AgentKind::kCattle:
      return cattle_mps;
    case AgentKind::kDog:
      return dog_mps;
    case AgentKind::kVehicle:
      return vehicle_mps;
    case AgentKind::kPerson:
      break;
  }
  return person_mps;
}

Eigen::Matrix2d FilteredAgent::spread_after(double t, double walk) const {
  const double variance = position_variance + 2.0 * t * covariance + t * t * velocity_variance +
                          walk * walk * t * t * t / 3.0;
  return variance * Eigen::Matrix2d::Identity();
}

FilteredAgent AgentFilter::first_sight(const Agent& agent) const {
  FilteredAgent first{agent.id, agent.kind, agent.radius_m, agent.position};
  const double noise = std::max(agent.noise_m, config_.least_noise_m);
  first.position_variance = noise * noise;
  first.velocity_variance = config_.first_speed_mps * config_.first_speed_mps;
  const double speed = agent.velocity.norm();
  if (speed > 0.0 && speed < kFastest) {
    first.velocity = agent.velocity;
    first.velocity_variance = std::min(first.velocity_variance, kSeenSpeedNoise * kSeenSpeedNoise);
  }
  first.first_s = now_;
  first.last_s = now_;
  return first;
}

FilteredAgent AgentFilter::updated(FilteredAgent known, const FilteredAgent& seen) const {
  const double dt = now_ - known.last_s;
  const Point2 ahead = known.position_after(dt);
  const double noise_variance = seen.position_variance;
  const double reachable =
      kFastest * dt + 5.0 * std::sqrt(noise_variance + known.position_variance);
  const bool is_same = dt <= kForgetAfter && seen.kind == known.kind &&
                       (seen.position - known.position).norm() <= reachable;
  if (!is_same) return seen;
  const double walk = config_.walk.of(known.kind);
  const double q = walk * walk;
  double& pp = known.position_variance;
  double& pv = known.covariance;
  double& vv = known.velocity_variance;
  pp += dt * (2.0 * pv + dt * (vv + q * dt / 3.0));
  pv += dt * (vv + q * dt / 2.0);
  vv += q * dt;
  const double position_gain = pp / (pp + noise_variance);
  const double velocity_gain = pv / (pp + noise_variance);
  const Point2 error = seen.position - ahead;
  // The acceleration is how far the velocity is ahead of its own low-pass.
  const Point2 slow = known.velocity - config_.acceleration_s * known.acceleration;
  known.position = ahead + position_gain * error;
  known.velocity += velocity_gain * error;
  vv -= velocity_gain * pv;
  pv *= 1.0 - position_gain;
  pp *= 1.0 - position_gain;
  if (now_ - known.first_s > kSettled) {
    const double kept = std::exp(-dt / config_.acceleration_s);
    known.acceleration = kept * (known.velocity - slow) / config_.acceleration_s;
  }
  known.radius_m = seen.radius_m;
  known.last_s = now_;
  return known;
}

void AgentFilter::observe(std::span<const Agent> agents, double time_s) {
  if (std::isfinite(time_s) && (known_.empty() || time_s > now_)) now_ = time_s;
  seen_.clear();
  for (const Agent& agent : agents) {
    if (is_usable(agent)) seen_.push_back(first_sight(agent));
  }
  order_.resize(seen_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(), [this](int a, int b) {
    const int id_a = seen_[static_cast<std::size_t>(a)].id;
    const int id_b = seen_[static_cast<std::size_t>(b)].id;
    return id_a < id_b || (id_a == id_b && a < b);
  });
  // Those known and those seen, both by id, side by side.
  next_.clear();
  auto known = known_.begin();
  const auto keep_unseen_below = [&](int id) {
    for (; known != known_.end() && known->id < id; ++known) {
      if (now_ - known->last_s <= kForgetAfter) next_.push_back(*known);
    }
  };
  for (const int slot : order_) {
    FilteredAgent& seen = seen_[static_cast<std::size_t>(slot)];
    if (!next_.empty() && next_.back().id == seen.id) continue;
    keep_unseen_below(seen.id);
    if (known != known_.end() && known->id == seen.id) seen = updated(*known++, seen);
    next_.push_back(seen);
  }
  keep_unseen_below(std::numeric_limits<int>::max());
  std::swap(known_, next_);
}

}  // namespace headland
