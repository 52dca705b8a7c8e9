// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "core/geometry/pose2.hpp"
#include "core/model/slip.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

/// What moves a vehicle: the speed of its wheels v [m/s, signed], its turn (Ackermann: the steering
/// angle delta [rad]; differential: the yaw rate omega of its wheels [rad/s]), and its slip
/// s, beta [rad], alpha [rad].
template <class T>
using Drive = Eigen::Matrix<T, 5, 1>;
enum DriveIndex { kSpeed = 0, kTurn = 1, kLoss = 2, kSide = 3, kOffset = 4 };
inline constexpr int kDriveSize = 5;

inline Drive<double> make_drive(double speed, double turn, const Slip& slip) {
  Drive<double> drive;
  drive << speed, turn, slip.loss_ratio, slip.side_rad, slip.steering_offset_rad;
  return drive;
}

/// A vehicle's motion over ground with slip (bicycle and differential, one form):
///   x' = v (1-s) cos(psi + beta), y' = v (1-s) sin(psi + beta),
///   psi' = v (1-s) cos(beta) tan(delta + alpha) / L                    (Ackermann)
///   psi' = (1-s) omega + v (1-s) cos(beta) tan(alpha) / L              (differential)
/// Estimator and controller share it, and differentiate it. Deterministic, does not allocate.
class MotionModel {
 public:
  /// `wheelbase` [m] > 0.
  MotionModel(Steering steering, double wheelbase)
      : ackermann_(steering == Steering::kAckermann), wheelbase_(wheelbase) {}
  explicit MotionModel(const Vehicle& vehicle)
      : MotionModel(vehicle.steering, vehicle.wheelbase_m) {}

  bool ackermann() const { return ackermann_; }
  double wheelbase() const { return wheelbase_; }  ///< [m]

  /// psi' [rad/s].
  template <class T>
  T yaw_rate(const Drive<T>& w) const {
    using std::cos, std::tan;
    const T ground = w(kSpeed) * (1.0 - w(kLoss)) * cos(w(kSide)) / wheelbase_;
    return ackermann_ ? T(ground * tan(w(kTurn) + w(kOffset)))
                      : T((1.0 - w(kLoss)) * w(kTurn) + ground * tan(w(kOffset)));
  }

  /// The turn (steering angle or yaw rate) with which the vehicle's travel has `curvature` [1/m, of
  /// the direction of travel over ground, positive left] in spite of its slip, at `speed` [m/s].
  double turn_for(double curvature, double speed, const Slip& slip) const;

  /// d yaw_rate / d drive.
  template <class T>
  Drive<T> yaw_rate_gradient(const Drive<T>& w) const {
    using std::cos, std::sin, std::tan;
    const T keep = 1.0 - w(kLoss);
    const T c = cos(w(kSide)) / wheelbase_;
    const T bend = tan(ackermann_ ? T(w(kTurn) + w(kOffset)) : T(w(kOffset)));
    const T by_angle = w(kSpeed) * keep * c * (1.0 + bend * bend);
    Drive<T> g;
    g(kSpeed) = keep * c * bend;
    g(kTurn) = ackermann_ ? by_angle : keep;
    g(kLoss) = -w(kSpeed) * c * bend - (ackermann_ ? T(0.0) : w(kTurn));
    g(kSide) = -w(kSpeed) * keep * sin(w(kSide)) / wheelbase_ * bend;
    g(kOffset) = by_angle;
    return g;
  }

  /// Displacement T_base(0)_base(dt) as (x [m], y [m], yaw [rad]) while the drive changes evenly
  /// from `begin` to `end` over `dt` [s]: Simpson's rule for the yaw and, with it, for the position
  /// (error of order dt^5).
  template <class T>
  Eigen::Matrix<T, 3, 1> displacement(const Drive<T>& begin, const Drive<T>& end, double dt) const {
    return integrate<T, false>(begin, end, dt, nullptr, nullptr);
  }

  template <class T>
  using Jacobian = Eigen::Matrix<T, 3, kDriveSize>;

  /// The same with its derivatives to `begin` and `end`.
  template <class T>
  Eigen::Matrix<T, 3, 1> displacement(const Drive<T>& begin, const Drive<T>& end, double dt,
                                      Jacobian<T>& by_begin, Jacobian<T>& by_end) const {
    return integrate<T, true>(begin, end, dt, &by_begin, &by_end);
  }

 private:
  // One node of Simpson's rule: the velocity over ground in the frame of the begin.
  template <class T>
  struct Node {
    Node(const Drive<T>& w, const T& yaw) : speed(w(kSpeed) * (1.0 - w(kLoss))) {
      using std::cos, std::sin;
      along << cos(yaw + w(kSide)), sin(yaw + w(kSide));
    }
    Eigen::Matrix<T, 2, 1> velocity() const { return speed * along; }
    T speed;                       // [m/s]
    Eigen::Matrix<T, 2, 1> along;  // direction of travel
  };

  template <class T, bool kDerive>
  Eigen::Matrix<T, 3, 1> integrate(const Drive<T>& begin, const Drive<T>& end, double dt,
                                   Jacobian<T>* by_begin, Jacobian<T>* by_end) const {
    const Drive<T> middle = 0.5 * (begin + end);
    const T r0 = yaw_rate<T>(begin);
    const T rm = yaw_rate<T>(middle);
    const T r1 = yaw_rate<T>(end);
    // The parabola through the three rates, integrated to the middle and to the end.
    const double sixth = dt / 6.0;
    const double part = dt / 24.0;
    const T yaw_m = part * (5.0 * r0 + 8.0 * rm - r1);
    const T yaw_1 = sixth * (r0 + 4.0 * rm + r1);
    const Node<T> n0(begin, T(0.0));
    const Node<T> nm(middle, yaw_m);
    const Node<T> n1(end, yaw_1);
    const Eigen::Matrix<T, 2, 1> sum = n0.velocity() + 4.0 * nm.velocity() + n1.velocity();
    Eigen::Matrix<T, 3, 1> moved;
    moved << sixth * sum(0), sixth * sum(1), yaw_1;
    if constexpr (kDerive) {
      const Drive<T> g0 = yaw_rate_gradient<T>(begin);
      const Drive<T> gm = 0.5 * yaw_rate_gradient<T>(middle);  // to begin and to end alike
      const Drive<T> g1 = yaw_rate_gradient<T>(end);
      by_begin->setZero();
      by_end->setZero();
      by_begin->row(2) = sixth * (g0 + 4.0 * gm).transpose();
      by_end->row(2) = sixth * (g1 + 4.0 * gm).transpose();
      const Drive<T> yaw_m_begin = part * (5.0 * g0 + 8.0 * gm);
      const Drive<T> yaw_m_end = part * (8.0 * gm - g1);
      const Drive<T> none = Drive<T>::Zero();
      const Drive<T> yaw_begin = by_begin->row(2).transpose();
      const Drive<T> yaw_end = by_end->row(2).transpose();
      add_velocity(*by_begin, sixth, begin, n0, 1.0, none);
      add_velocity(*by_begin, 4.0 * sixth, middle, nm, 0.5, yaw_m_begin);
      add_velocity(*by_begin, sixth, end, n1, 0.0, yaw_begin);
      add_velocity(*by_end, 4.0 * sixth, middle, nm, 0.5, yaw_m_end);
      add_velocity(*by_end, sixth, end, n1, 1.0, yaw_end);
    }
    return moved;
  }

  // Adds weight * d(velocity) at a node whose drive `w` moves by `share` of the variable, and whose
  // yaw has the gradient `yaw`.
  template <class T>
  static void add_velocity(Jacobian<T>& jacobian, double weight, const Drive<T>& w,
                           const Node<T>& node, double share, const Drive<T>& yaw) {
    Drive<T> course = yaw;
    course(kSide) += share;
    jacobian.row(0) -= (weight * node.speed * node.along(1) * course).transpose();
    jacobian.row(1) += (weight * node.speed * node.along(0) * course).transpose();
    for (int axis = 0; axis < 2; ++axis) {
      jacobian(axis, kSpeed) += weight * share * (1.0 - w(kLoss)) * node.along(axis);
      jacobian(axis, kLoss) -= weight * share * w(kSpeed) * node.along(axis);
    }
  }

  bool ackermann_;
  double wheelbase_;
};

}  // namespace headland
