// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"

namespace headland {

/// How far the fixes and the odometry are trusted.
struct PositionFilterConfig {
  /// The error of a fix is uniform in +- this on each axis [m] ((004) Sec. 3, "accuracy"); 0: fixes
  /// are exact and taken as they are.
  double fix_accuracy_m = 0.0;
  /// Standard deviation of dead reckoning after one metre, growing with the square root of the
  /// distance [m]: wheels on soil, without what the two errors below explain.
  double odometry_drift_m = 0.001;
  /// Standard deviation of the odometry's scale (wheel radius, slip) as a ratio of the distance.
  double scale_error_ratio = 0.01;
  /// Standard deviation of the direction of travel against the measured heading [deg]: mounting of
  /// the compass, drift on a side slope.
  double heading_error_deg = 0.5;
  /// Distance over which scale and direction may become others [m].
  double error_memory_m = 2000.0;

  template <class V>
  void visit(V& v) {
    v("fix_accuracy_m", fix_accuracy_m, config::kNonNegative,
      "Half width of a fix's uniform error on each axis [m]; 0: exact fixes");
    v("odometry_drift_m", odometry_drift_m, config::kNonNegative,
      "Standard deviation of dead reckoning after one metre driven [m]");
    v("scale_error_ratio", scale_error_ratio, config::Range{0.0, 0.5},
      "Standard deviation of the odometry's scale");
    v("heading_error_deg", heading_error_deg, config::Range{0.0, 20.0},
      "Standard deviation of the direction of travel against the heading [deg]");
    v("error_memory_m", error_memory_m, config::kPositive,
      "Distance over which scale and direction may change [m]");
  }
};

/// Position from noisy fixes and the vehicle's own motion: a Kalman filter over the position and
/// two slow errors of the odometry, its scale and its direction, all linear in the displacement.
/// Deterministic, does not allocate.
class PositionFilter {
 public:
  explicit PositionFilter(const PositionFilterConfig& config);

  /// Forgets all; the next fix is taken as it is.
  void reset();
  /// One cycle: `displacement` [m, map] since the last fix by odometry, then `fix` [m, map].
  void update(const Point2& displacement, const Point2& fix);

  Point2 position() const { return state_.head<2>(); }  ///< [m, map]
  double scale_error() const { return state_(2); }      ///< true over told distance, less one
  double heading_error() const { return state_(3); }    ///< of travel against the heading [rad]
  double position_variance() const { return covariance_(0, 0); }  ///< [m^2]

 private:
  void predict(const Point2& displacement);

  double fix_variance_;      // [m^2]
  double drift_variance_;    // [m^2] per metre
  double scale_variance_;    // []
  double heading_variance_;  // [rad^2]
  double memory_;            // [m]
  Eigen::Vector4d state_ = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance_ = Eigen::Matrix4d::Zero();
  bool started_ = false;
};

}  // namespace headland
