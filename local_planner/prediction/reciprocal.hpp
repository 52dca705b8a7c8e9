// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/config/visit.hpp"
#include "core/model/orca.hpp"
#include "local_planner/prediction/agent_filter.hpp"
#include "local_planner/prediction/predictor.hpp"

namespace headland {

/// How agents are expected to give way.
struct ReciprocalConfig {
  double horizon_s = 3.0;
  double range_m = 12.0;
  double robot_radius_m = 1.5;
  double robot_share_ratio = 0.5;
  double max_speed_mps = 1.5;
  int neighbors_count = 8;
  AgentFilterConfig filter;

  template <class V>
  void visit(V& v) {
    v("horizon_s", horizon_s, config::kPositive, "Agents look ahead so far [s]");
    v("range_m", range_m, config::kPositive,
      "Agents nearer to the robot than this are expected to react, others to go straight on [m]");
    v("robot_radius_m", robot_radius_m, config::kNonNegative,
      "That agents are expected to assume of the robot [m]");
    v("robot_share_ratio", robot_share_ratio, config::kFraction,
      "Of the avoidance that agents are expected to take on towards the robot");
    v("max_speed_mps", max_speed_mps, config::kPositive, "The most that agents do [m/s]");
    v("neighbors_count", neighbors_count, config::Range{0, 100},
      "Agents give way to this many of their nearest");
    v("filter", filter, "How their velocities are found");
  }
};

/// Agents keep their velocity (found by a Kalman filter) but for reciprocal avoidance (ORCA) of
/// each other and of the robot on its planned path.
class ReciprocalPredictor : public Predictor {
 public:
  explicit ReciprocalPredictor(const ReciprocalConfig& config = {})
      : config_(config), filter_(config.filter) {}

  void observe(std::span<const Agent> agents, const Point2& robot, const Point2& robot_velocity,
               double time_s) override;
  void predict(std::span<const Point2> robot_path, double step_s, int steps,
               Prediction& prediction) const override;
  bool reacts() const override { return true; }

 private:
  struct Body {
    Point2 position{0.0, 0.0};
    Point2 velocity{0.0, 0.0};
    Point2 next{0.0, 0.0};  // velocity
    double radius = 0.3;
    bool reacts = true;
    std::vector<int> neighbors;
  };
  void find_neighbors() const;
  void step(const OrcaNeighbor& robot, double dt) const;

  ReciprocalConfig config_;
  AgentFilter filter_;
  Point2 robot_{0.0, 0.0};
  // Scratch of predict(): kept for its memory.
  mutable std::vector<Body> bodies_;
  mutable std::vector<VelocityLine> lines_;
  mutable std::vector<VelocityLine> scratch_;
};

}  // namespace headland
