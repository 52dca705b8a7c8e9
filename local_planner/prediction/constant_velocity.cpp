// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/constant_velocity.hpp"

namespace headland {

void ConstantVelocityPredictor::predict(std::span<const Point2>, double step_s, int steps,
                                        Prediction& prediction) const {
  prediction.begin(step_s, steps);
  for (const FilteredAgent& known : filter_.agents()) {
    prediction.ids.push_back(known.agent.id);
    prediction.radius_m.push_back(known.agent.radius_m);
    for (int k = 1; k <= steps; ++k) {
      const double t = k * step_s;
      prediction.mean.push_back(known.agent.position + t * known.agent.velocity);
      prediction.covariance.push_back(known.variance_at(t, filter_.config().acceleration_density) *
                                      Eigen::Matrix2d::Identity());
    }
  }
}

}  // namespace headland
