// SPDX-License-Identifier: Apache-2.0
#include "control/position_filter.hpp"

#include <cmath>

#include <Eigen/LU>

namespace headland {
namespace {

double squared(double x) { return x * x; }

}  // namespace

PositionFilter::PositionFilter(const PositionFilterConfig& config)
    // A uniform error in +-a has the variance a^2 / 3.
    : fix_variance_(squared(config.fix_accuracy_m) / 3.0),
      drift_variance_(squared(config.odometry_drift_m)),
      scale_variance_(squared(config.scale_error_ratio)),
      heading_variance_(squared(deg_to_rad(config.heading_error_deg))),
      memory_(config.error_memory_m) {}

void PositionFilter::reset() {
  started_ = false;
  state_.setZero();
  covariance_.setZero();
}

// p += (1 + scale) d + heading * (d turned left); the two errors fade with the distance and are
// stirred so that their variances stay what the configuration says (Gauss-Markov).
void PositionFilter::predict(const Point2& displacement) {
  const double distance = displacement.norm();
  const double keep = std::exp(-distance / memory_);
  Eigen::Matrix4d transition = Eigen::Matrix4d::Identity();
  transition.block<2, 1>(0, 2) = displacement;
  transition.block<2, 1>(0, 3) = Point2(-displacement.y(), displacement.x());
  transition(2, 2) = keep;
  transition(3, 3) = keep;
  state_ = (transition * state_).eval();
  state_.head<2>() += displacement;
  covariance_ = (transition * covariance_ * transition.transpose()).eval();
  covariance_(0, 0) += drift_variance_ * distance;
  covariance_(1, 1) += drift_variance_ * distance;
  covariance_(2, 2) += scale_variance_ * (1.0 - keep * keep);
  covariance_(3, 3) += heading_variance_ * (1.0 - keep * keep);
}

void PositionFilter::update(const Point2& displacement, const Point2& fix) {
  if (!started_ || fix_variance_ == 0.0) {
    started_ = true;
    state_ << fix, 0.0, 0.0;
    covariance_.diagonal() << fix_variance_, fix_variance_, scale_variance_, heading_variance_;
    return;
  }
  predict(displacement);
  const Eigen::Matrix2d innovation =
      covariance_.topLeftCorner<2, 2>() + fix_variance_ * Eigen::Matrix2d::Identity();
  const Eigen::Matrix<double, 4, 2> gain = covariance_.leftCols<2>() * innovation.inverse();
  state_ += gain * (fix - state_.head<2>());
  // Symmetric by construction, so that rounding cannot make it indefinite over long drives.
  covariance_ -= (gain * innovation * gain.transpose()).eval();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

}  // namespace headland
