// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/world/lidar.hpp"

namespace headland::internal {

/// Error-state Kalman filter of a rigid body with an inertial unit at its origin.
///
/// Notation: p, v [m, m/s] in odom; R: T_odom_body's rotation; bg [rad/s], ba [m/s2]: biases; g
/// [m/s2]: gravity in odom, of fixed length. Errors: p + dp, R Exp(dtheta), v + dv, bg + dbg,
/// ba + dba, Exp(B dg) g with B across g; 17 numbers in this order.
/// Without an inertial unit the body keeps its velocity and turns on at -bg, both with much noise.
class InertialFilter {
 public:
  static constexpr int kSize = 17;
  enum Index { kP = 0, kTheta = 3, kV = 6, kBg = 9, kBa = 12, kG = 15 };
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  struct State {
    Eigen::Vector3d p{0.0, 0.0, 0.0};
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    Eigen::Vector3d v{0.0, 0.0, 0.0};
    Eigen::Vector3d bg{0.0, 0.0, 0.0};
    Eigen::Vector3d ba{0.0, 0.0, 0.0};
    Eigen::Vector3d g{0.0, 0.0, -9.81};

    /// The state with an error put in.
    State plus(const Vector& error) const;
    /// The error that makes `from` this state.
    Vector minus(const State& from) const;
  };

  /// White noises, over one second.
  struct Noise {
    double gyro_radps = 0.01;
    double accelerometer_mps2 = 0.2;
    double gyro_bias_radps = 1e-4;
    double accelerometer_bias_mps2 = 1e-3;
    double free_acceleration_mps2 = 1.5;  ///< without an inertial unit
    double free_turn_radps2 = 1.0;        ///< likewise
  };

  explicit InertialFilter(const Noise& noise) : noise_(noise) {}

  void reset(const State& state, const Vector& deviation);
  const State& state() const { return state_; }
  const Matrix& covariance() const { return covariance_; }

  /// The state after `dt` [s] of a reading in the body's frame (none: no inertial unit), and the
  /// derivatives of its error.
  static State moved_on(const State& state, const std::optional<ImuReading>& reading, double dt,
                        Matrix& by_error);
  void propagate(const std::optional<ImuReading>& reading, double dt);

  /// Velocity of a point fixed to the body at `arm` from its origin, in the body's frame, with the
  /// body turning at `turn` (as read), and its derivatives.
  static Eigen::Vector3d velocity_at(const State& state, const Eigen::Vector3d& arm,
                                     const Eigen::Vector3d& turn,
                                     Eigen::Matrix<double, 3, kSize>& by_error);
  /// Wheels' speed ahead and no speed to the side and up, with their deviations. False: rejected
  /// (99 % gate).
  bool update_velocity(const Eigen::Vector3d& velocity, const Eigen::Vector3d& deviation,
                       const Eigen::Vector3d& arm, const Eigen::Vector3d& turn, bool gated);

  /// For an iterated update: takes over state and covariance.
  void set(const State& state, const Matrix& covariance) {
    state_ = state;
    covariance_ = covariance;
  }

 private:
  Noise noise_;
  State state_;
  Matrix covariance_ = Matrix::Identity();
};

}  // namespace headland::internal
