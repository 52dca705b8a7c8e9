// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/model/orca.hpp"
#include "local_planner/prediction/companions.hpp"
#include "local_planner/prediction/nearest_agents.hpp"

namespace headland {

/// How agents are taken to avoid each other and the robot.
struct Avoidance {
  double horizon_s = 3.0;
  double neighbor_m = 10.0;
  int neighbor_count = 10;
  double max_speed_mps = 1.5;
  double robot_radius_m = 1.5;
  double robot_share_ratio = 0.5;

  template <class V>
  void visit(V& v) {
    v("horizon_s", horizon_s, config::kPositive, "They keep apart for this long [s]");
    v("neighbor_m", neighbor_m, config::kNonNegative, "They see each other up to here [m]");
    v("neighbor_count", neighbor_count, config::Range{0, 1000}, "... and of these the nearest");
    v("max_speed_mps", max_speed_mps, config::kNonNegative,
      "They avoid at up to this speed, or their own [m/s]");
    v("robot_radius_m", robot_radius_m, config::kNonNegative,
      "Of the robot, as they see it; seed 003: 1.5 m [m]");
    v("robot_share_ratio", robot_share_ratio, config::kFraction,
      "Of the avoidance between robot and agent that is the agent's; 0: they do not see it");
  }
};

struct OrcaConfig {
  AgentFilterConfig filter;
  VelocityWalk spread{0.1, 0.55, 0.4, 1.0, 0.3};
  CompanionModel companions;
  Avoidance avoidance;

  template <class V>
  void visit(V& v) {
    v("filter", filter, "Of the agents");
    v("spread", spread,
      "How far velocities wander after the last sight, beside the filter's doubt");
    v("companions", companions, "Of people");
    v("avoidance", avoidance, "Of all agents");
  }
};

/// Agents that want to go on as CompanionPredictor has them, and avoid each other and the robot on
/// its path by ORCA. Those who are nearer to each other than their radii keep the distance that
/// they have. Takes about 1 us per agent and step; does not allocate once its buffers have held as
/// many agents.
class OrcaPredictor : public Predictor {
 public:
  explicit OrcaPredictor(const OrcaConfig& config = {});

  void observe(std::span<const Agent> agents, const Point2& robot, const Point2& robot_velocity,
               double time_s) override;
  void predict(std::span<const Point2> robot_path, double step_s, int steps,
               Prediction& prediction) const override;
  bool reacts() const override { return config_.avoidance.robot_share_ratio > 0.0; }

 private:
  struct Body {
    Point2 position{0.0, 0.0};
    Point2 velocity{0.0, 0.0};
  };
  Point2 avoiding_velocity(std::size_t self, const Body& robot, const Point2& preferred,
                           double dt) const;
  double kept_distance(std::size_t a, std::size_t b) const;

  OrcaConfig config_;
  AgentFilter filter_;
  NearestAgents nearest_;
  Point2 robot_{0.0, 0.0};
  std::vector<Point2> positions_;
  std::vector<Point2> velocities_;  // that agents want
  // Scratch of a prediction.
  mutable std::vector<Body> bodies_;
  mutable std::vector<Body> next_;
  mutable std::vector<VelocityLine> lines_;
  mutable std::vector<VelocityLine> program_;
};

}  // namespace headland
