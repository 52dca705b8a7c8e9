// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "control/estimation/estimation_config.hpp"
#include "core/model/kinematics.hpp"
#include "core/model/measurement.hpp"
#include "core/model/motion.hpp"

namespace headland {

/// Pose x [m], y [m], yaw [rad], then the Drive: speed, turn, loss, side slip, steering offset.
using EstimateVector = Eigen::Matrix<double, 8, 1>;
using EstimateMatrix = Eigen::Matrix<double, 8, 8>;

/// What measurements of one kind say about the state: expected value and its derivatives.
struct MeasurementModel {
  int size = 1;              ///< numbers measured
  Eigen::Vector2d residual;  ///< measured less expected; of a heading, wrapped
  Eigen::Matrix<double, 2, 8> by_state;
};
MeasurementModel model_measurement(const MotionModel& motion, const EstimateVector& state,
                                   const Measurement& measurement);

/// How speed and turn answer to a command: their change, and the share of what they were that is
/// kept (1: the actuator moves at its limit; 0: it is where the command wants it).
struct ActuatorAnswer {
  Eigen::Vector2d change = Eigen::Vector2d::Zero();
  Eigen::Vector2d keep = Eigen::Vector2d::Ones();
};

/// The motion model, the noise and the bounds that estimators of one vehicle share.
class EstimationModel {
 public:
  EstimationModel(const Vehicle& vehicle, const EstimationConfig& config);

  const MotionModel& motion() const { return motion_; }
  const EstimationConfig& config() const { return config_; }

  EstimateVector vector_of(const VehicleState& state, const Slip& slip) const;
  VehicleEstimate estimate_of(const EstimateVector& state) const;
  EstimateMatrix first_covariance() const;
  /// To a command that acts for `dt` [s]; `actual`: speed and turn before.
  ActuatorAnswer answer(const Eigen::Vector2d& actual, const Command& acting, double dt) const;
  /// The state after `dt` [s] under a command that acts.
  EstimateVector coast(const EstimateVector& state, const Command& acting, double dt) const;
  /// Variances that `dt` [s] at the speed of `state` add, the pose's first.
  EstimateVector noise(const EstimateVector& state, double dt) const;
  /// Of a measurement's noise, with what the model may be off on top.
  double variance(const Measurement& measurement) const;
  void keep_bounds(EstimateVector& state) const;
  /// Largest magnitude of loss ratio, side slip [rad] and steering offset [rad].
  const Eigen::Vector3d& slip_bounds() const { return slip_bounds_; }

 private:
  Eigen::Vector2d actuate(const Eigen::Vector2d& actual, const Command& acting, double dt) const;

  Vehicle vehicle_;
  EstimationConfig config_;
  MotionModel motion_;
  Eigen::Vector3d slip_bounds_;
  EstimateVector per_metre_ = EstimateVector::Zero();
  EstimateVector per_second_ = EstimateVector::Zero();
};

/// Extended Kalman filter over pose, drive and slip. Does not allocate.
class KalmanFilter {
 public:
  explicit KalmanFilter(const EstimationModel& model) : model_(&model) {}

  void reset(const EstimateVector& state, const EstimateMatrix& covariance);
  /// `dt` [s] under a command that acts; `inflation` multiplies the variances that it adds to the
  /// slip (loss, side, offset).
  void predict(const Command& acting, double dt,
               const Eigen::Vector3d& inflation = Eigen::Vector3d::Ones());
  void update(const Measurement& measurement);

  const EstimateVector& state() const { return state_; }
  const EstimateMatrix& covariance() const { return covariance_; }
  bool finite() const { return state_.allFinite() && covariance_.allFinite(); }

 private:
  const EstimationModel* model_;
  EstimateVector state_ = EstimateVector::Zero();
  EstimateMatrix covariance_ = EstimateMatrix::Identity();
};

}  // namespace headland
