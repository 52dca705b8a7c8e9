// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "local_planner/prediction/agent_filter.hpp"
#include "local_planner/prediction/predictor.hpp"

namespace headland {

/// Agents go on at the velocity that a Kalman filter finds for them.
class ConstantVelocityPredictor : public Predictor {
 public:
  explicit ConstantVelocityPredictor(const AgentFilterConfig& config = {}) : filter_(config) {}

  void observe(std::span<const Agent> agents, const Point2&, const Point2&,
               double time_s) override {
    filter_.observe(agents, time_s);
  }
  void predict(std::span<const Point2> robot_path, double step_s, int steps,
               Prediction& prediction) const override;

 private:
  AgentFilter filter_;
};

}  // namespace headland
