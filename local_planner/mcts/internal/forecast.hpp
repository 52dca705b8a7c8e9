// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/world/agent.hpp"
#include "local_planner/mcts/mcts_planner.hpp"

namespace headland::mcts {

/// What the agents mean for one step of the robot. Risk rises with the square of how far the
/// distance between the discs is below clearance_m, counted in squared distances: 1 at contact.
struct StepRisk {
  double cost = 0.0;     ///< risk_ratio times the sum over agents, less the farther ahead [s/s]
  bool contact = false;  ///< the robot's disc meets an agent's while the robot moves
};

/// Where the agents are at the ends of the tree's steps, laid out for the tree's inner loop: one
/// row of agents per step. Positions are relative to an origin near the robot.
class Forecast {
 public:
  /// The agents nearest to the robot. `robot_radius` [m].
  void set(const Prediction& prediction, std::span<const Agent> now, const Point2& origin,
           double robot_radius, const MctsConfig& config);

  int agents() const { return count_; }
  const Point2& origin() const { return origin_; }

  /// Step `level` -> `level` + 1 of the robot's centre from (ax, ay) to (bx, by), against agents
  /// that move straight at the same time: continuous, not at the ends alone.
  StepRisk step(int level, double ax, double ay, double bx, double by, double speed) const;

  /// How far agents who hardly move stand in the way from a to b after the last step, in [0, 1].
  double obstruction(double ax, double ay, double bx, double by) const;

  /// The first of (003) Eq. 1's sums, at the end of that step: alpha U over all agents (Eq. 2).
  double seed_cost(int level, double x, double y) const;

  /// Where the agents with these ids were expected to be at `level` and a fraction beyond; false
  /// for unknown ids.
  bool expected(int id, double level, Point2& position) const;

 private:
  std::size_t row(int level) const {
    return static_cast<std::size_t>(level) * static_cast<std::size_t>(padded_);
  }

  Point2 origin_{0.0, 0.0};
  int count_ = 0;
  int padded_ = 0;  // a multiple of four: rows are vectors
  int levels_ = 0;
  double influence_ = 3.0;
  std::vector<int> ids_;
  std::vector<float> x_;  // [level][agent]
  std::vector<float> y_;
  std::vector<float> uncertainty_;  // U [m2], [level][agent]
  std::vector<float> rim_;          // square of the distance where risk begins [m2], [agent]
  std::vector<float> scale_;        // makes that less the square of the contact's 1 [1/m2], [agent]
  std::vector<float> lingers_;      // 1: stands; 0: leaves, [agent]
  bool anyone_lingers_ = false;
  std::vector<float> weight_;  // of risk, [level]
};

}  // namespace headland::mcts
