// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "local_planner/prediction/constant_velocity.hpp"

namespace headland {

/// People who walk together share a velocity: what one of them does beside the others is a step
/// aside, or an error of the filter. Fitted on the ETH, hotel and zara01 scenes, each left out
/// once.
struct CompanionModel {
  double near_m = 2.0;
  double alike_mps = 0.5;
  double stopping_s = 50.0;

  template <class V>
  void visit(V& v) {
    v("near_m", near_m, config::kPositive, "Companions are about this near [m]");
    v("alike_mps", alike_mps, config::kPositive, "... and about this alike in velocity [m/s]");
    v("stopping_s", stopping_s, config::kPositive,
      "Time constant at which people slow down, as some of them stop [s]");
  }
};

/// The velocities [m/s] that agents go on with: people's and their companions' mean, weighted by
/// exp(-(distance / near)^2 - (difference / alike)^2), themselves by 1; others' as they are.
/// `velocities` is overwritten. O(n^2), about 3 ns per pair.
void companion_velocities(const CompanionModel& model, std::span<const FilteredAgent> agents,
                          std::vector<Point2>& velocities);

/// How far someone of that kind gets in `t` [s] at 1 m/s: people slow down.
double way_after(const CompanionModel& model, AgentKind kind, double t);

struct CompanionConfig {
  AgentFilterConfig filter;
  VelocityWalk spread{0.1, 0.55, 0.4, 1.0, 0.3};
  CompanionModel companions;

  template <class V>
  void visit(V& v) {
    v("filter", filter, "Of the agents");
    v("spread", spread,
      "How far velocities wander after the last sight, beside the filter's doubt");
    v("companions", companions, "Of people");
  }
};

/// Constant velocity, with the velocity of their company for people.
class CompanionPredictor : public Predictor {
 public:
  explicit CompanionPredictor(const CompanionConfig& config = {});

  void observe(std::span<const Agent> agents, const Point2& robot, const Point2& robot_velocity,
               double time_s) override;
  void predict(std::span<const Point2> robot_path, double step_s, int steps,
               Prediction& prediction) const override;

 private:
  CompanionConfig config_;
  AgentFilter filter_;
  std::vector<Point2> velocities_;
};

}  // namespace headland
