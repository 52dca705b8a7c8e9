// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include "core/model/kinematics.hpp"
#include "core/model/measurement.hpp"

namespace headland {

enum class EstimateStatus {
  kGood,
  kCoasting,  ///< no position for longer than the estimator trusts its own motion
  kFailed     ///< no estimate: the state is the last good one
};

/// What an estimator knows at one time.
struct Estimate {
  VehicleEstimate vehicle;
  EstimateStatus status = EstimateStatus::kGood;
  /// Standard deviations of x [m], y [m], yaw [rad], speed [m/s], turn ([rad] or [rad/s]), loss
  /// ratio, side slip [rad], steering offset [rad]; zero where the estimator knows none.
  Eigen::Matrix<double, 8, 1> deviation = Eigen::Matrix<double, 8, 1>::Zero();
  int late_count = 0;     ///< measurements since the start that came too late to be used
  int refused_count = 0;  ///< measurements since the start from the future, or no numbers
};

/// From measurements, which may come late, and the commands given, to the state of now. Updates do
/// not allocate and do not throw. Deterministic.
class Estimator {
 public:
  virtual ~Estimator() = default;
  /// Starts anew, at rest or moving, with what is known of the state at time `now` [s].
  virtual void reset(const VehicleState& start, double now) = 0;
  /// Takes what has been measured since the last update, in any order, and gives the estimate for
  /// `now` [s], which never decreases. `last` is the command given at the last update.
  virtual Estimate update(std::span<const Measurement> measured, const Command& last,
                          double now) = 0;
};

}  // namespace headland
