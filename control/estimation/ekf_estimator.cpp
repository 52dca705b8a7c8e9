// SPDX-License-Identifier: Apache-2.0
#include "control/estimation/ekf_estimator.hpp"

#include <algorithm>
#include <cmath>

namespace headland {

EkfEstimator::EkfEstimator(const Vehicle& vehicle, const EstimationConfig& config, double cycle)
    : model_(vehicle, config),
      log_(vehicle, cycle, config.most_delay_s),
      behind_(model_),
      now_(model_) {}

void EkfEstimator::reset(const VehicleState& start, double now) {
  log_.reset(now);
  behind_.reset(model_.vector_of(start, {}), model_.first_covariance());
  now_ = behind_;
}

Estimate EkfEstimator::update(std::span<const Measurement> measured, const Command& last,
                              double now) {
  log_.take(measured, last, now);
  const long delay = std::lround(model_.config().most_delay_s / log_.cycle());
  if (const long base = log_.now() - delay; base > log_.base()) {
    log_.replay(behind_, base);
    log_.forget_before(base);
  }
  KalmanFilter newest = behind_;
  log_.replay(newest, log_.now());
  const bool good = newest.finite();
  if (good) now_ = newest;
  Estimate estimate =
      make_estimate(model_, log_, now_.state(), now_.covariance().diagonal().cwiseMax(0.0));
  if (!good) {
    estimate.status = EstimateStatus::kFailed;
    if (!behind_.finite()) behind_.reset(now_.state(), model_.first_covariance());
  }
  return estimate;
}

Estimate make_estimate(const EstimationModel& model, const EstimationLog& log,
                       const EstimateVector& state, const EstimateVector& variance) {
  Estimate estimate;
  estimate.vehicle = model.estimate_of(state);
  estimate.deviation = variance.cwiseSqrt();
  const double silent = log.time(log.now()) - log.last_position();
  if (silent > model.config().coasting_after_s) estimate.status = EstimateStatus::kCoasting;
  estimate.late_count = log.late_count();
  estimate.refused_count = log.refused_count();
  return estimate;
}

}  // namespace headland
