// SPDX-License-Identifier: Apache-2.0
#include "control/estimation/kalman_filter.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

double squared(double value) { return value * value; }

constexpr int kDriveAt = 3;  // where the drive begins in the state

}  // namespace

MeasurementModel model_measurement(const MotionModel& motion, const EstimateVector& state,
                                   const Measurement& measurement) {
  MeasurementModel model;
  model.residual.setZero();
  model.by_state.setZero();
  const Drive<double> drive = state.tail<kDriveSize>();
  switch (measurement.kind) {
    case MeasurementKind::kPosition:
      model.size = 2;
      model.residual << measurement.value[0] - state(0), measurement.value[1] - state(1);
      model.by_state(0, 0) = model.by_state(1, 1) = 1.0;
      break;
    case MeasurementKind::kHeading:
      model.residual(0) = wrap_angle(measurement.value[0] - state(2));
      model.by_state(0, 2) = 1.0;
      break;
    case MeasurementKind::kSpeed:
      model.residual(0) = measurement.value[0] - drive(kSpeed);
      model.by_state(0, kDriveAt + kSpeed) = 1.0;
      break;
    case MeasurementKind::kTurn:
      model.residual(0) = measurement.value[0] - drive(kTurn);
      model.by_state(0, kDriveAt + kTurn) = 1.0;
      break;
    case MeasurementKind::kYawRate:
      model.residual(0) = measurement.value[0] - motion.yaw_rate<double>(drive);
      model.by_state.row(0).tail<kDriveSize>() =
          motion.yaw_rate_gradient<double>(drive).transpose();
      break;
  }
  return model;
}

EstimationModel::EstimationModel(const Vehicle& vehicle, const EstimationConfig& config)
    : vehicle_(vehicle),
      config_(config),
      motion_(vehicle),
      slip_bounds_(config.most_loss_ratio, deg_to_rad(config.most_side_deg),
                   deg_to_rad(config.most_offset_deg)) {
  per_metre_ << squared(config.position_drift_m), squared(config.position_drift_m),
      squared(deg_to_rad(config.heading_drift_deg)), 0.0, 0.0, squared(config.loss_walk_ratio),
      squared(deg_to_rad(config.side_walk_deg)), squared(deg_to_rad(config.offset_walk_deg));
  per_second_(kDriveAt + kSpeed) = squared(config.speed_walk_mps);
  per_second_(kDriveAt + kTurn) =
      squared(motion_.ackermann() ? deg_to_rad(config.turn_walk_deg) : config.yaw_rate_walk_radps);
}

EstimateVector EstimationModel::vector_of(const VehicleState& state, const Slip& slip) const {
  EstimateVector vector;
  vector << state.pose.x, state.pose.y, state.pose.yaw,
      make_drive(state.speed, motion_.ackermann() ? state.steering : state.yaw_rate, slip);
  return vector;
}

VehicleEstimate EstimationModel::estimate_of(const EstimateVector& state) const {
  VehicleEstimate estimate;
  estimate.state.pose = {state(0), state(1), wrap_angle(state(2))};
  estimate.state.speed = state(kDriveAt + kSpeed);
  (motion_.ackermann() ? estimate.state.steering : estimate.state.yaw_rate) =
      state(kDriveAt + kTurn);
  estimate.slip = {state(kDriveAt + kLoss), state(kDriveAt + kSide), state(kDriveAt + kOffset)};
  return estimate;
}

EstimateMatrix EstimationModel::first_covariance() const {
  EstimateVector variance;
  variance << squared(config_.first_position_m), squared(config_.first_position_m),
      squared(deg_to_rad(config_.first_heading_deg)), squared(config_.speed_walk_mps),
      per_second_(kDriveAt + kTurn), squared(config_.first_loss_ratio),
      squared(deg_to_rad(config_.first_side_deg)), squared(deg_to_rad(config_.first_offset_deg));
  return variance.asDiagonal();
}

Eigen::Vector2d EstimationModel::actuate(const Eigen::Vector2d& actual, const Command& acting,
                                         double dt) const {
  return {step_speed(vehicle_, actual(0), acting.speed, dt),
          motion_.ackermann() ? step_steering(vehicle_, actual(1), acting.steering, dt)
                              : step_yaw_rate(vehicle_, actual(1), acting.yaw_rate, dt)};
}

ActuatorAnswer EstimationModel::answer(const Eigen::Vector2d& actual, const Command& acting,
                                       double dt) const {
  // The actuators' laws are linear between their limits: any small step gives the slope.
  constexpr double kStep = 1e-6;
  const Eigen::Vector2d after = actuate(actual, acting, dt);
  const Eigen::Vector2d beside = actuate(actual.array() + kStep, acting, dt);
  return {after - actual, ((beside - after) / kStep).cwiseMax(0.0).cwiseMin(1.0)};
}

EstimateVector EstimationModel::coast(const EstimateVector& state, const Command& acting,
                                      double dt) const {
  const Drive<double> begin = state.tail<kDriveSize>();
  Drive<double> end = begin;
  end.head<2>() = actuate(begin.head<2>(), acting, dt);
  const Eigen::Vector3d moved = motion_.displacement<double>(begin, end, dt);
  const Pose2 pose = Pose2{state(0), state(1), state(2)} * Pose2{moved(0), moved(1), moved(2)};
  EstimateVector after;
  after << pose.x, pose.y, pose.yaw, end;
  return after;
}

EstimateVector EstimationModel::noise(const EstimateVector& state, double dt) const {
  return std::abs(state(kDriveAt + kSpeed)) * dt * per_metre_ + dt * per_second_;
}

double EstimationModel::variance(const Measurement& measurement) const {
  const auto least = [&] {
    switch (measurement.kind) {
      case MeasurementKind::kPosition:
        return config_.least_position_m;
      case MeasurementKind::kHeading:
        return deg_to_rad(config_.least_heading_deg);
      case MeasurementKind::kSpeed:
        return config_.least_speed_mps;
      case MeasurementKind::kTurn:
        return deg_to_rad(config_.least_turn_deg);
      case MeasurementKind::kYawRate:
        break;
    }
    return config_.least_yaw_rate_radps;
  };
  return squared(std::max(measurement.deviation, least()));
}

void EstimationModel::keep_bounds(EstimateVector& state) const {
  state.tail<3>() = state.tail<3>().cwiseMax(-slip_bounds_).cwiseMin(slip_bounds_);
}

void KalmanFilter::reset(const EstimateVector& state, const EstimateMatrix& covariance) {
  state_ = state;
  covariance_ = covariance;
}

void KalmanFilter::predict(const Command& acting, double dt, const Eigen::Vector3d& inflation) {
  const Drive<double> begin = state_.tail<kDriveSize>();
  Drive<double> end = begin;
  const ActuatorAnswer answer = model_->answer(begin.head<2>(), acting, dt);
  end.head<2>() += answer.change;
  Drive<double> keep = Drive<double>::Ones();
  keep.head<2>() = answer.keep;
  EstimateVector noise = model_->noise(state_, dt);
  noise.tail<3>() = noise.tail<3>().cwiseProduct(inflation);
  MotionModel::Jacobian<double> by_begin;
  MotionModel::Jacobian<double> by_end;
  const Eigen::Vector3d moved =
      model_->motion().displacement<double>(begin, end, dt, by_begin, by_end);
  const double c = std::cos(state_(2));
  const double s = std::sin(state_(2));
  Eigen::Matrix3d turned;
  turned << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  const Eigen::Vector3d step = turned * moved;
  EstimateMatrix transition = EstimateMatrix::Identity();
  transition(0, 2) = -step(1);
  transition(1, 2) = step(0);
  transition.topRightCorner<3, kDriveSize>() = turned * (by_begin + by_end * keep.asDiagonal());
  transition.diagonal().tail<kDriveSize>() = keep;
  state_.head<3>() += step;
  state_.tail<kDriveSize>() = end;
  covariance_ = (transition * covariance_ * transition.transpose()).eval();
  covariance_.diagonal() += noise;
}

// One number after the other: their noises are independent.
void KalmanFilter::update(const Measurement& measurement) {
  const MeasurementModel seen = model_measurement(model_->motion(), state_, measurement);
  const double variance = model_->variance(measurement);
  EstimateVector change = EstimateVector::Zero();
  for (int i = 0; i < seen.size; ++i) {
    const EstimateVector row = seen.by_state.row(i).transpose();
    const EstimateVector spread = covariance_ * row;
    const EstimateVector gain = spread / (row.dot(spread) + variance);
    change += gain * (seen.residual(i) - row.dot(change));
    covariance_ -= gain * spread.transpose();
  }
  state_ += change;
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  model_->keep_bounds(state_);
}

}  // namespace headland
