// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/run/localizer_estimator.hpp"

#include <cmath>

#include "core/geometry/angle.hpp"

namespace headland {
namespace {

constexpr double kFirstPosition = 0.05;  // standard deviation at the start [m]
constexpr double kFirstYaw = 1.0;        // [deg]

LocalizerConfig fitted(const Vehicle& vehicle, LocalizerConfig config) {
  const bool ackermann = vehicle.steering == Steering::kAckermann;
  config.wheelbase_m = ackermann ? vehicle.wheelbase_m : 0.0;
  if (vehicle.lidar) {
    config.odometry.lidar = *vehicle.lidar;
    config.odometry.imu = *vehicle.lidar;
  }
  return config;
}

EstimateStatus status_of(PoseState state) {
  switch (state) {
    case PoseState::kGood:
      return EstimateStatus::kGood;
    case PoseState::kCoasting:
      return EstimateStatus::kCoasting;
    case PoseState::kStarting:
    case PoseState::kLost:
      break;
  }
  return EstimateStatus::kFailed;
}

}  // namespace

LocalizerEstimator::LocalizerEstimator(const Vehicle& vehicle, LocalizerConfig config)
    : vehicle_(vehicle), localizer_(fitted(vehicle, std::move(config))) {}

void LocalizerEstimator::reset(const VehicleState& start, double now) {
  const double yaw = deg_to_rad(kFirstYaw);
  const Eigen::Vector3d variance(kFirstPosition * kFirstPosition, kFirstPosition * kFirstPosition,
                                 yaw * yaw);
  localizer_.start(now, start.pose, variance.asDiagonal());
  estimate_ = {};
  estimate_.vehicle.state = start;
}

void LocalizerEstimator::add(const ImuReading& reading) {
  inertial_ = true;
  localizer_.add(reading);
}

void LocalizerEstimator::add(const Measurement& reading) {
  if (inertial_ && reading.kind == MeasurementKind::kYawRate) return;
  switch (localizer_.add(reading)) {
    case ReadingOutcome::kTooOld:
      ++estimate_.late_count;
      break;
    case ReadingOutcome::kInvalid:
      ++estimate_.refused_count;
      break;
    default:
      break;
  }
  VehicleState& state = estimate_.vehicle.state;
  const bool steers = vehicle_.steering == Steering::kAckermann;
  if (reading.kind == MeasurementKind::kTurn && steers) state.steering = reading.value[0];
}

Estimate LocalizerEstimator::update(std::span<const Measurement> measured, const Command& /*last*/,
                                    double now) {
  for (const Measurement& reading : measured) add(reading);
  const PoseEstimate& pose = localizer_.estimate(now);
  VehicleState& state = estimate_.vehicle.state;
  state.pose = pose.pose;
  state.speed = pose.speed_mps;
  state.yaw_rate = pose.yaw_rate_radps;
  estimate_.status = status_of(pose.health.state);
  estimate_.deviation.head<3>() = pose.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  return estimate_;
}

}  // namespace headland
