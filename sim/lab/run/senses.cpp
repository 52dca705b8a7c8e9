// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/run/senses.hpp"

namespace headland {

EstimatorKind estimator_for(const Vehicle& vehicle, const ControlConfig& control,
                            const PerceptionConfig& perception) {
  if (control.estimator != EstimatorKind::kAuto) return control.estimator;
  const bool perceives = vehicle.lidar && perception.enabled;
  return perceives ? EstimatorKind::kLocalizer : EstimatorKind::kSensors;
}

Senses::Senses(const Vehicle& vehicle, const ControlConfig& control,
               const PerceptionConfig& perception, const LidarScene* scene, double cycle,
               std::uint64_t seed)
    : cycle_(cycle), scene_(vehicle.lidar ? scene : nullptr) {
  if (control.estimator == EstimatorKind::kLocalizer) {
    auto localizer = std::make_unique<LocalizerEstimator>(vehicle, perception.localizer);
    localizer_ = localizer.get();
    estimator_ = std::move(localizer);
  } else {
    estimator_ = make_estimator(vehicle, control, cycle);
  }
  if (scene_ == nullptr) return;
  lidar_.emplace(*vehicle.lidar, perception.lidar, perception.period_s, *scene_, seed);
  inertial_.emplace(perception.inertial, *vehicle.lidar, seed);
  rows_.emplace(vehicle, perception, cycle);
}

void Senses::begin(const VehicleState& truth) {
  known_ = truth;
  if (estimator_ != nullptr) estimator_->reset(truth, 0.0);
}

void Senses::step(double time, SimulatedVehicle& vehicle, const Command& told,
                  std::span<const Agent> agents, bool idle) {
  if (lidar_) perceive(time, vehicle.truth().pose, agents);
  if (estimator_ != nullptr) {
    const Estimate estimate = estimator_->update(vehicle.sense(time), told, time);
    known_ = estimate.vehicle;
    lost_s_ = estimate.status == EstimateStatus::kFailed ? lost_s_ + cycle_ : 0.0;
  } else if (!idle) {
    known_ = vehicle.measure();
  }
}

// A localizer goes by all scans, rows by those within them.
void Senses::perceive(double time, const Pose2& truth, std::span<const Agent> agents) {
  scan_ = lidar_->step(time, truth, agents, localizer_ != nullptr || rows_->in_row());
  if (localizer_ == nullptr) return;
  const auto reading = inertial_->sense(scene_->pose_on_ground(truth), time);
  if (reading) localizer_->add(*reading);
  if (scan_ != nullptr) localizer_->add(*scan_);
}

void Senses::look_at_row(double time, const Pose2& truth, const Path& path, double s, int leg,
                         double row_width) {
  if (!rows_) return;
  if (leg != row_leg_) {
    row_leg_ = leg;
    rows_->begin_row(row_width);
  }
  rows_->step(time, scan_, truth, path, s, known_);
}

}  // namespace headland
