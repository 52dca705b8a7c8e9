// SPDX-License-Identifier: Apache-2.0
#include "control/lookahead_rover/position_filter.hpp"

namespace headland {

PositionFilter::PositionFilter(const PositionFilterConfig& config)
    // A uniform error in +-a has the variance a^2 / 3.
    : fix_variance_(config.fix_accuracy_m * config.fix_accuracy_m / 3.0),
      drift_variance_1m_(config.odometry_drift_m * config.odometry_drift_m) {}

void PositionFilter::reset() {
  started_ = false;
  variance_ = 0.0;
}

Point2 PositionFilter::update(const Point2& displacement, const Point2& fix) {
  if (!started_ || fix_variance_ == 0.0) {
    started_ = true;
    estimate_ = fix;
    variance_ = fix_variance_;
    return estimate_;
  }
  const double predicted = variance_ + drift_variance_1m_ * displacement.norm();
  const double gain = predicted / (predicted + fix_variance_);
  estimate_ += displacement;
  estimate_ += gain * (fix - estimate_);
  variance_ = (1.0 - gain) * predicted;
  return estimate_;
}

}  // namespace headland
