// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/config/visit.hpp"
#include "core/world/agent.hpp"

namespace headland {

/// How agents' velocities are found from sights of them.
struct AgentFilterConfig {
  double acceleration_density = 0.5;
  double noise_m = 0.05;
  double forget_s = 1.0;

  template <class V>
  void visit(V& v) {
    v("acceleration_density", acceleration_density, config::kPositive,
      "Spectral density of the agents' acceleration [m2/s3]");
    v("noise_m", noise_m, config::kPositive, "A sight is no more exact than this, per axis [m]");
    v("forget_s", forget_s, config::kPositive, "Agents not seen for so long are forgotten [s]");
  }
};

/// What is known of an agent. Both axes are alike and independent: one covariance of position and
/// velocity per axis.
struct FilteredAgent {
  Agent agent;                     ///< position and velocity: the estimate
  double seen_s = 0.0;             ///< when it was seen last
  double variance = 0.0;           ///< of the position [m2]
  double cross = 0.0;              ///< [m2/s]
  double velocity_variance = 0.0;  ///< [m2/s2]

  /// Variance of the position `t` [s] on at constant velocity [m2].
  double variance_at(double t, double acceleration) const {
    return variance + 2.0 * t * cross + t * t * velocity_variance + acceleration * t * t * t / 3.0;
  }
};

/// A constant-velocity Kalman filter per agent (white-noise acceleration). Sights with anything
/// that is no number are left out; sights back in time are ignored.
class AgentFilter {
 public:
  explicit AgentFilter(const AgentFilterConfig& config = {}) : config_(config) {}

  /// A sight of all agents near, at `time_s`. O(n log n).
  void observe(std::span<const Agent> agents, double time_s);
  /// Those of the last sight, by id; the estimates are of that time.
  std::span<const FilteredAgent> agents() const { return {known_.data(), current_}; }
  const AgentFilterConfig& config() const { return config_; }

 private:
  FilteredAgent update(const FilteredAgent* before, const Agent& seen, double time_s) const;

  AgentFilterConfig config_;
  std::vector<FilteredAgent> known_;  // of the last sight, by id; then others
  std::vector<FilteredAgent> next_;
  std::size_t current_ = 0;
  double time_s_ = 0.0;
};

}  // namespace headland
