// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/config/visit.hpp"
#include "core/world/agent.hpp"

namespace headland {

/// How far the velocities of agents wander, by their kind: the standard deviation per axis after
/// one second of white acceleration [m/s].
struct VelocityWalk {
  double person_mps = 0.3;
  double sheep_mps = 1.2;
  double cattle_mps = 0.8;
  double dog_mps = 2.0;
  double vehicle_mps = 0.5;

  template <class V>
  void visit(V& v) {
    v("person_mps", person_mps, config::kPositive, "After one second [m/s]");
    v("sheep_mps", sheep_mps, config::kPositive, "[m/s]");
    v("cattle_mps", cattle_mps, config::kPositive, "[m/s]");
    v("dog_mps", dog_mps, config::kPositive, "[m/s]");
    v("vehicle_mps", vehicle_mps, config::kPositive, "[m/s]");
  }
  double of(AgentKind kind) const;
};

struct AgentFilterConfig {
  VelocityWalk walk;
  double least_noise_m = 0.05;
  double first_speed_mps = 1.5;
  double acceleration_s = 0.5;

  template <class V>
  void visit(V& v) {
    v("walk", walk, "What the filters expect: more than agents do on average, to follow turns");
    v("least_noise_m", least_noise_m, config::kPositive,
      "No position is trusted more, whatever Agent::noise_m says [m]");
    v("first_speed_mps", first_speed_mps, config::kPositive,
      "Standard deviation per axis of the velocity of whom is seen first [m/s]");
    v("acceleration_s", acceleration_s, config::kPositive,
      "Over which accelerations are meant [s]");
  }
};

/// What is known of an agent. Both axes have the same covariance.
struct FilteredAgent {
  int id = 0;
  AgentKind kind = AgentKind::kPerson;
  double radius_m = 0.3;
  Point2 position{0.0, 0.0};       ///< [m, map]
  Point2 velocity{0.0, 0.0};       ///< [m/s]
  Point2 acceleration{0.0, 0.0};   ///< [m/s2], low-passed; zero in the first half second
  double position_variance = 0.0;  ///< [m2]
  double covariance = 0.0;         ///< of position and velocity [m2/s]
  double velocity_variance = 0.0;  ///< [m2/s2]
  double first_s = 0.0;            ///< seen first
  double last_s = 0.0;             ///< seen last

  Point2 position_after(double t) const { return position + t * velocity; }
  /// Covariance of the position after `t` [s] at a velocity that wanders by `walk` [m/s].
  Eigen::Matrix2d spread_after(double t, double walk) const;
};

/// A Kalman filter per agent: positions are measured, acceleration is white. Whom it has not seen
/// for a second it forgets; who jumps, or changes the kind, is somebody else with the same id.
class AgentFilter {
 public:
  explicit AgentFilter(const AgentFilterConfig& config) : config_(config) {}

  /// A sight at `time_s`; sights come in order (earlier, or no number: taken for the time of the
  /// last one). Agents with anything that is not finite, or beyond 1e7 m, are left out; of two
  /// with one id the second is filtered as if seen first. O(n log n); does not allocate once it
  /// has held as many.
  void observe(std::span<const Agent> agents, double time_s);
  /// All of the last sight, in its order.
  std::span<const FilteredAgent> seen() const { return seen_; }

 private:
  FilteredAgent first_sight(const Agent& agent) const;
  FilteredAgent updated(FilteredAgent known, const FilteredAgent& seen) const;

  AgentFilterConfig config_;
  double now_ = 0.0;
  std::vector<FilteredAgent> seen_;
  std::vector<int> order_;            // of those seen, by id
  std::vector<FilteredAgent> known_;  // by id, each once
  std::vector<FilteredAgent> next_;
};

}  // namespace headland
