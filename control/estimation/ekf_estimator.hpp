// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/estimation/estimation_log.hpp"
#include "control/estimation/estimator.hpp"

namespace headland {

/// The baseline: an extended Kalman filter over pose, drive and slip. Measurements that come late,
/// up to `most_delay_s`, are filtered at their own time: the filter stands that far behind and is
/// replayed from there.
class EkfEstimator : public Estimator {
 public:
  /// `cycle` [s]: of the updates.
  EkfEstimator(const Vehicle& vehicle, const EstimationConfig& config, double cycle);
  EkfEstimator(const EkfEstimator&) = delete;  // its filters point to its model
  EkfEstimator& operator=(const EkfEstimator&) = delete;

  void reset(const VehicleState& start, double now) override;
  Estimate update(std::span<const Measurement> measured, const Command& last, double now) override;

 private:
  EstimationModel model_;
  EstimationLog log_;
  KalmanFilter behind_;  // at the log's base
  KalmanFilter now_;
};

/// What all estimators tell of a filter's or smoother's end.
Estimate make_estimate(const EstimationModel& model, const EstimationLog& log,
                       const EstimateVector& state, const EstimateVector& variance);

}  // namespace headland
