// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "local_planner/prediction/agent_filter.hpp"
#include "local_planner/prediction/predictor.hpp"

namespace headland {

struct ConstantVelocityConfig {
  AgentFilterConfig filter;
  VelocityWalk spread{0.16, 0.55, 0.4, 1.0, 0.3};

  template <class V>
  void visit(V& v) {
    v("filter", filter, "Of the agents");
    v("spread", spread,
      "How far velocities wander after the last sight, beside the filter's doubt");
  }
};

/// All go on as they move now. Takes about 20 ns per agent and step; does not allocate once its
/// buffers have held as many agents.
class ConstantVelocityPredictor : public Predictor {
 public:
  explicit ConstantVelocityPredictor(const ConstantVelocityConfig& config = {});

  void observe(std::span<const Agent> agents, const Point2& robot, const Point2& robot_velocity,
               double time_s) override;
  void predict(std::span<const Point2> robot_path, double step_s, int steps,
               Prediction& prediction) const override;

 private:
  ConstantVelocityConfig config_;
  AgentFilter filter_;
};

/// Whether steps of `step_s` [s] can be predicted: more than none, and none longer than 10 s.
bool can_predict(double step_s, int steps);

/// Makes room for all agents, writes who they are, and their covariances by what the filter does
/// not know and by `spread`. If that cannot be predicted, there are no steps. The means are left
/// to the caller.
void begin_prediction(std::span<const FilteredAgent> agents, const VelocityWalk& spread,
                      double step_s, int steps, Prediction& prediction);

}  // namespace headland
