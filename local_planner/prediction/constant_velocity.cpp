// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/constant_velocity.hpp"

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

bool can_predict(double step_s, int steps) { return step_s > 0.0 && step_s <= 10.0 && steps > 0; }

void begin_prediction(std::span<const FilteredAgent> agents, const VelocityWalk& spread,
                      double step_s, int steps, Prediction& prediction) {
  prediction.step_s = step_s;
  prediction.steps = can_predict(step_s, steps) ? steps : 0;
  prediction.ids.clear();
  prediction.radius_m.clear();
  prediction.covariance.clear();
  for (const FilteredAgent& agent : agents) {
    prediction.ids.push_back(agent.id);
    prediction.radius_m.push_back(agent.radius_m);
    const double walk = spread.of(agent.kind);
    for (int k = 1; k <= prediction.steps; ++k) {
      prediction.covariance.push_back(agent.spread_after(k * step_s, walk));
    }
  }
  prediction.mean.resize(prediction.covariance.size());
}

}  // namespace headland
