// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/constant_velocity.hpp"

#include "local_planner/prediction/prediction_steps.hpp"

namespace headland {

ConstantVelocityPredictor::ConstantVelocityPredictor(const ConstantVelocityConfig& config)
    : config_(config), filter_(config.filter) {}

void ConstantVelocityPredictor::observe(std::span<const Agent> agents, const Point2&, const Point2&,
                                        double time_s) {
  filter_.observe(agents, time_s);
}

void ConstantVelocityPredictor::predict(std::span<const Point2>, double step_s, int steps,
                                        Prediction& prediction) const {
  begin_prediction(filter_.seen(), config_.spread, step_s, steps, prediction);
  auto mean = prediction.mean.begin();
  for (const FilteredAgent& agent : filter_.seen()) {
    for (int k = 1; k <= prediction.steps; ++k) *mean++ = agent.position_after(k * step_s);
  }
}

}  // namespace headland
