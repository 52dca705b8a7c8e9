// SPDX-License-Identifier: Apache-2.0
#include "perception/localization/internal/inertial_filter.hpp"

#include "perception/localization/internal/kalman.hpp"
#include "perception/localization/internal/rotation.hpp"

namespace headland::internal {
namespace {

double squared(double value) { return value * value; }

}  // namespace

InertialFilter::State InertialFilter::State::plus(const Vector& error) const {
  State state;
  state.p = p + error.segment<3>(kP);
  state.R = R * rotation_by(error.segment<3>(kTheta));
  state.v = v + error.segment<3>(kV);
  state.bg = bg + error.segment<3>(kBg);
  state.ba = ba + error.segment<3>(kBa);
  state.g = rotation_by(across(g) * error.segment<2>(kG)) * g;
  return state;
}

InertialFilter::Vector InertialFilter::State::minus(const State& from) const {
  Vector error;
  const Eigen::Vector3d n = from.g.normalized();
  const Eigen::Vector3d turn = n.cross(g.normalized());
  error << p - from.p, rotation_vector(from.R.transpose() * R), v - from.v, bg - from.bg,
      ba - from.ba, across(from.g).transpose() * turn;
  return error;
}

void InertialFilter::reset(const State& state, const Vector& deviation) {
  state_ = state;
  covariance_ = deviation.cwiseAbs2().asDiagonal();
}

InertialFilter::State InertialFilter::moved_on(const State& state,
                                               const std::optional<ImuReading>& reading, double dt,
                                               Matrix& by_error) {
  State after = state;
  by_error.setIdentity();
  by_error.block<3, 3>(kP, kV).diagonal().setConstant(dt);
  Eigen::Vector3d turn = -state.bg;
  if (reading) {
    turn += reading->angular_rate;
    const Eigen::Vector3d force = reading->specific_force - state.ba;
    const Eigen::Vector3d acceleration = state.R * force + state.g;
    const Eigen::Matrix3d by_theta = -state.R * cross(force);
    const Eigen::Matrix<double, 3, 2> by_g = -cross(state.g) * across(state.g);
    after.p += 0.5 * dt * dt * acceleration;
    after.v += dt * acceleration;
    by_error.block<3, 3>(kP, kTheta) = 0.5 * dt * dt * by_theta;
    by_error.block<3, 3>(kP, kBa) = -0.5 * dt * dt * state.R;
    by_error.block<3, 2>(kP, kG) = 0.5 * dt * dt * by_g;
    by_error.block<3, 3>(kV, kTheta) = dt * by_theta;
    by_error.block<3, 3>(kV, kBa) = -dt * state.R;
    by_error.block<3, 2>(kV, kG) = dt * by_g;
  }
  const Eigen::Matrix3d turned = rotation_by(turn * dt);
  after.p += dt * state.v;
  after.R = state.R * turned;
  by_error.block<3, 3>(kTheta, kTheta) = turned.transpose();
  // The right Jacobian of the rotation, to second order in the angle turned.
  by_error.block<3, 3>(kTheta, kBg) = -dt * (Eigen::Matrix3d::Identity() - 0.5 * cross(turn * dt) +
                                             cross(turn * dt) * cross(turn * dt) / 6.0);
  return after;
}

void InertialFilter::propagate(const std::optional<ImuReading>& reading, double dt) {
  Matrix by_error;
  state_ = moved_on(state_, reading, dt, by_error);
  covariance_ = (by_error * covariance_ * by_error.transpose()).eval();
  auto variance = covariance_.diagonal();
  if (reading) {
    variance.segment<3>(kTheta).array() += squared(noise_.gyro_radps) * dt;
    variance.segment<3>(kV).array() += squared(noise_.accelerometer_mps2) * dt;
    variance.segment<3>(kBg).array() += squared(noise_.gyro_bias_radps) * dt;
    variance.segment<3>(kBa).array() += squared(noise_.accelerometer_bias_mps2) * dt;
  } else {
    variance.segment<3>(kV).array() += squared(noise_.free_acceleration_mps2) * dt;
    variance.segment<3>(kBg).array() += squared(noise_.free_turn_radps2) * dt;
  }
}

Eigen::Vector3d InertialFilter::velocity_at(const State& state, const Eigen::Vector3d& arm,
                                            const Eigen::Vector3d& turn,
                                            Eigen::Matrix<double, 3, kSize>& by_error) {
  const Eigen::Vector3d v_body = state.R.transpose() * state.v;
  by_error.setZero();
  by_error.middleCols<3>(kTheta) = cross(v_body);
  by_error.middleCols<3>(kV) = state.R.transpose();
  by_error.middleCols<3>(kBg) = cross(arm);
  return v_body + (turn - state.bg).cross(arm);
}

bool InertialFilter::update_velocity(const Eigen::Vector3d& velocity,
                                     const Eigen::Vector3d& deviation, const Eigen::Vector3d& arm,
                                     const Eigen::Vector3d& turn, bool gated) {
  Innovation<kSize, 3> seen;
  seen.residual = velocity - velocity_at(state_, arm, turn, seen.by_state);
  seen.noise = deviation.cwiseAbs2().asDiagonal();
  if (gated && seen.squared_distance(covariance_) > gate_99(3)) return false;
  Vector error = Vector::Zero();
  update<kSize, 3>(error, covariance_, seen);
  state_ = state_.plus(error);
  return true;
}

}  // namespace headland::internal
