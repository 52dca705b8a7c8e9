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
  /// distance [m]. Small: smooth and slow to correct; the seed's rover rolls without slip, so that
  /// its odometry is exact.
  double odometry_drift_m = 0.0003;

  template <class V>
  void visit(V& v) {
    v("fix_accuracy_m", fix_accuracy_m, config::kNonNegative,
      "Half width of a fix's uniform error on each axis [m]; 0: exact fixes");
    v("odometry_drift_m", odometry_drift_m, config::kNonNegative,
      "Standard deviation of dead reckoning after one metre driven [m]");
  }
};

/// Position from noisy fixes and the vehicle's own motion: a Kalman filter whose two axes share one
/// variance, so that its gain is a scalar. Starts as the running mean of the fixes (carried along
/// by the odometry) and settles at the gain where the drift of one cycle balances the fix's error.
/// Deterministic, does not allocate.
class PositionFilter {
 public:
  explicit PositionFilter(const PositionFilterConfig& config);

  /// Forgets all; the next fix is taken as it is.
  void reset();
  /// One cycle: `displacement` [m, map] since the last fix by odometry, then `fix` [m, map].
  /// @return the estimate [m, map].
  Point2 update(const Point2& displacement, const Point2& fix);

  const Point2& estimate() const { return estimate_; }
  double variance() const { return variance_; }  ///< of each axis [m^2]

 private:
  double fix_variance_;       // [m^2]
  double drift_variance_1m_;  // [m^2] per metre
  Point2 estimate_{0.0, 0.0};
  double variance_ = 0.0;
  bool started_ = false;
};

}  // namespace headland
