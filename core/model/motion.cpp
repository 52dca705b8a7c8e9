// SPDX-License-Identifier: Apache-2.0
#include "core/model/motion.hpp"

namespace headland {

double MotionModel::turn_for(double curvature, double speed, const Slip& slip) const {
  const double bend = curvature * wheelbase_ / std::cos(slip.side_rad);
  if (ackermann_) return std::atan(bend) - slip.steering_offset_rad;
  // (1-s) omega + v (1-s) cos(beta) tan(alpha) / L = v (1-s) curvature
  return speed *
         (curvature - std::cos(slip.side_rad) * std::tan(slip.steering_offset_rad) / wheelbase_);
}

}  // namespace headland
