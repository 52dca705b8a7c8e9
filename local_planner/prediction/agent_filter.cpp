// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/agent_filter.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kFirstSpeed = 1.0;  // standard deviation of an unknown velocity [m/s]

bool usable(const Agent& agent) {
  return agent.position.allFinite() && std::isfinite(agent.radius_m) && agent.radius_m >= 0.0;
}

bool by_id(const FilteredAgent& a, const FilteredAgent& b) { return a.agent.id < b.agent.id; }

}  // namespace

FilteredAgent AgentFilter::update(const FilteredAgent* before, const Agent& seen,
                                  double time_s) const {
  const double noise = std::max(config_.noise_m, std::isfinite(seen.noise_m) ? seen.noise_m : 0.0);
  FilteredAgent now;
  now.agent = seen;
  now.seen_s = time_s;
  if (before == nullptr) {
    if (!seen.velocity.allFinite()) now.agent.velocity.setZero();
    now.variance = noise * noise;
    now.velocity_variance = kFirstSpeed * kFirstSpeed;
    return now;
  }
  const double dt = time_s - before->seen_s;
  const double q = config_.acceleration_density;
  const double variance = before->variance_at(dt, q);
  const double cross = before->cross + dt * before->velocity_variance + 0.5 * q * dt * dt;
  const double velocity_variance = before->velocity_variance + q * dt;
  const double gain = variance / (variance + noise * noise);
  const double velocity_gain = cross / (variance + noise * noise);
  const Point2 expected = before->agent.position + dt * before->agent.velocity;
  const Point2 innovation = seen.position - expected;
  now.agent.position = expected + gain * innovation;
  now.agent.velocity = before->agent.velocity + velocity_gain * innovation;
  now.variance = (1.0 - gain) * variance;
  now.cross = (1.0 - gain) * cross;
  now.velocity_variance = velocity_variance - velocity_gain * cross;
  return now;
}

void AgentFilter::observe(std::span<const Agent> agents, double time_s) {
  if (!std::isfinite(time_s) || (!known_.empty() && time_s < time_s_)) return;
  time_s_ = time_s;
  std::sort(known_.begin(), known_.end(), by_id);
  next_.clear();
  for (const Agent& seen : agents) {
    if (!usable(seen)) continue;
    FilteredAgent key;
    key.agent.id = seen.id;
    const auto found = std::lower_bound(known_.begin(), known_.end(), key, by_id);
    const bool known = found != known_.end() && found->agent.id == seen.id &&
                       time_s - found->seen_s <= config_.forget_s;
    next_.push_back(update(known ? &*found : nullptr, seen, time_s));
  }
  std::sort(next_.begin(), next_.end(), by_id);
  const auto twice = std::unique(next_.begin(), next_.end(), [](const auto& a, const auto& b) {
    return a.agent.id == b.agent.id;
  });
  next_.erase(twice, next_.end());
  current_ = next_.size();
  // Who is hidden for a moment is remembered.
  for (const FilteredAgent& old : known_) {
    if (time_s - old.seen_s > config_.forget_s) continue;
    const auto end = next_.begin() + static_cast<std::ptrdiff_t>(current_);
    if (!std::binary_search(next_.begin(), end, old, by_id)) next_.push_back(old);
  }
  known_.swap(next_);
}

}  // namespace headland
