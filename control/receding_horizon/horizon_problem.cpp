// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/horizon_problem.hpp"

#include <algorithm>
#include <cmath>

#include <unsupported/Eigen/AutoDiff>

namespace headland {
namespace {

Drive<double> drive_of(double speed, double turn, const Slip& slip) {
  return make_drive(speed, turn, slip);
}

}  // namespace

HorizonState HorizonProblem::next(const HorizonState& x, const HorizonControl& u) const {
  const double speed = x(kWheelSpeed) + u(0) * interval_s;
  const double turn = x(kWheelTurn) + u(1) * interval_s;
  const Eigen::Vector3d moved = model.displacement<double>(
      drive_of(x(kWheelSpeed), x(kWheelTurn), slip), drive_of(speed, turn, slip), interval_s);
  const double c = std::cos(x(kYaw));
  const double s = std::sin(x(kYaw));
  HorizonState after;
  after << x(kX) + c * moved(0) - s * moved(1), x(kY) + s * moved(0) + c * moved(1),
      x(kYaw) + moved(2), speed, turn;
  return after;
}

HorizonState HorizonProblem::next(const HorizonState& x, const HorizonControl& u,
                                  StateMatrix& by_state, ControlMatrix& by_control) const {
  const double speed = x(kWheelSpeed) + u(0) * interval_s;
  const double turn = x(kWheelTurn) + u(1) * interval_s;
  MotionModel::Jacobian<double> by_begin;
  MotionModel::Jacobian<double> by_end;
  const Eigen::Vector3d moved =
      model.displacement<double>(drive_of(x(kWheelSpeed), x(kWheelTurn), slip),
                                 drive_of(speed, turn, slip), interval_s, by_begin, by_end);
  const double c = std::cos(x(kYaw));
  const double s = std::sin(x(kYaw));
  Eigen::Matrix3d turned;
  turned << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  const Eigen::Vector3d step = turned * moved;
  const Eigen::Matrix<double, 3, 2> end = turned * by_end.leftCols<2>();
  by_state.setIdentity();
  by_state(kX, kYaw) = -step(1);
  by_state(kY, kYaw) = step(0);
  by_state.topRightCorner<3, 2>() = turned * by_begin.leftCols<2>() + end;
  by_control.setZero();
  by_control.topRows<3>() = interval_s * end;
  by_control(kWheelSpeed, 0) = interval_s;
  by_control(kWheelTurn, 1) = interval_s;
  HorizonState after;
  after << x(kX) + step(0), x(kY) + step(1), x(kYaw) + step(2), speed, turn;
  return after;
}

// The gradient of multiplier' F with respect to yaw, speeds and turns at both ends of the interval,
// differentiated once more automatically.
Eigen::Matrix<double, 7, 7> HorizonProblem::curvature(const HorizonState& x,
                                                      const HorizonControl& u,
                                                      const HorizonState& multiplier) const {
  using Inputs = Eigen::Matrix<double, 5, 1>;  // yaw, speed, turn, speed after, turn after
  using Dual = Eigen::AutoDiffScalar<Inputs>;
  const double values[5] = {x(kYaw), x(kWheelSpeed), x(kWheelTurn),
                            x(kWheelSpeed) + u(0) * interval_s, x(kWheelTurn) + u(1) * interval_s};
  Dual in[5];
  for (int i = 0; i < 5; ++i) in[i] = Dual(values[i], 5, i);
  const Dual constant(0.0);
  Drive<Dual> begin;
  Drive<Dual> end;
  begin << in[1], in[2], constant + slip.loss_ratio, constant + slip.side_rad,
      constant + slip.steering_offset_rad;
  end << in[3], in[4], begin(kLoss), begin(kSide), begin(kOffset);
  MotionModel::Jacobian<Dual> by_begin;
  MotionModel::Jacobian<Dual> by_end;
  const Eigen::Matrix<Dual, 3, 1> moved =
      model.displacement<Dual>(begin, end, interval_s, by_begin, by_end);
  using std::cos, std::sin;
  const Dual c = cos(in[0]);
  const Dual s = sin(in[0]);
  // The multiplier in the frame of the begin.
  const Dual mx = c * multiplier(kX) + s * multiplier(kY);
  const Dual my = c * multiplier(kY) - s * multiplier(kX);
  const Dual gradient[5] = {
      my * moved(0) - mx * moved(1),
      mx * by_begin(0, kSpeed) + my * by_begin(1, kSpeed) + by_begin(2, kSpeed) * multiplier(kYaw),
      mx * by_begin(0, kTurn) + my * by_begin(1, kTurn) + by_begin(2, kTurn) * multiplier(kYaw),
      mx * by_end(0, kSpeed) + my * by_end(1, kSpeed) + by_end(2, kSpeed) * multiplier(kYaw),
      mx * by_end(0, kTurn) + my * by_end(1, kTurn) + by_end(2, kTurn) * multiplier(kYaw)};
  Eigen::Matrix<double, 5, 5> inner;
  for (int i = 0; i < 5; ++i) inner.row(i) = gradient[i].derivatives().transpose();
  // From these inputs to (x, u).
  Eigen::Matrix<double, 5, 7> chain = Eigen::Matrix<double, 5, 7>::Zero();
  chain(0, kYaw) = chain(1, kWheelSpeed) = chain(2, kWheelTurn) = 1.0;
  chain(3, kWheelSpeed) = chain(4, kWheelTurn) = 1.0;
  chain(3, 5) = chain(4, 6) = interval_s;
  return chain.transpose() * inner * chain;
}

HorizonProblem::StateMatrix HorizonProblem::state_weight(int k) const {
  const double yaw = stage(k).wanted(kYaw);
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  const double along = weights.along_weight;
  const double across = weights.across_weight;
  StateMatrix q = StateMatrix::Zero();
  q(kX, kX) = along * c * c + across * s * s;
  q(kY, kY) = along * s * s + across * c * c;
  q(kX, kY) = q(kY, kX) = (along - across) * c * s;
  q(kYaw, kYaw) = weights.heading_weight;
  q(kWheelSpeed, kWheelSpeed) = weights.speed_weight;
  q(kWheelTurn, kWheelTurn) = weights.turn_weight;
  return k == intervals() ? StateMatrix(weights.terminal_ratio * q) : q;
}

Eigen::Vector2d HorizonProblem::control_weight() const {
  return {weights.acceleration_weight, weights.turn_rate_weight};
}

void HorizonPlan::shift_into(HorizonPlan& shifted, double time, double interval) const {
  const int n = intervals();
  for (int k = 0; k <= n; ++k) {
    const double at = std::clamp(k + time / interval, 0.0, static_cast<double>(n));
    const int before = std::min(static_cast<int>(at), n - 1);
    const double part = at - before;
    const auto i = static_cast<std::size_t>(before);
    const auto to = static_cast<std::size_t>(k);
    shifted.states[to] = (1.0 - part) * states[i] + part * states[i + 1];
    if (k == n) break;
    const std::size_t after = std::min(i + 1, static_cast<std::size_t>(n) - 1);
    shifted.controls[to] = (1.0 - part) * controls[i] + part * controls[after];
  }
}

double cost(const HorizonProblem& problem, const HorizonPlan& plan) {
  double sum = 0.0;
  for (int k = 0; k <= problem.intervals(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const HorizonState off = plan.states[i] - problem.stage(k).wanted;
    sum += 0.5 * off.dot(problem.state_weight(k) * off);
    if (k == problem.intervals()) break;
    const HorizonControl push = plan.controls[i] - problem.stage(k).control;
    sum += 0.5 * push.dot(problem.control_weight().cwiseProduct(push));
  }
  return sum;
}

double dynamics_gap(const HorizonProblem& problem, const HorizonPlan& plan) {
  double gap = (plan.states[0] - problem.start).cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < plan.controls.size(); ++k) {
    const HorizonState reached = problem.next(plan.states[k], plan.controls[k]);
    gap = std::max(gap, (reached - plan.states[k + 1]).cwiseAbs().maxCoeff());
  }
  return gap;
}

}  // namespace headland
