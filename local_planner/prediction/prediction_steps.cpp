// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/prediction_steps.hpp"

#include <cmath>

namespace headland {

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

Point2 velocity_along(std::span<const Point2> robot_path, int step, const Point2& position,
                      double step_s) {
  const auto next = static_cast<std::size_t>(step);
  if (next >= robot_path.size() || !robot_path[next].allFinite()) return {0.0, 0.0};
  return (robot_path[next] - position) / step_s;
}

int parts_of(double step_s, double longest) {
  constexpr double kRounding = 1e-9;
  return static_cast<int>(std::ceil(step_s / longest - kRounding));
}

}  // namespace headland
