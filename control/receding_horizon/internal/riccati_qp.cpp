// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/internal/riccati_qp.hpp"

#include <algorithm>
#include <cmath>

namespace headland::control::internal {
namespace {

constexpr double kToBoundary = 0.995;   // share of the way to the boundary that a step goes
constexpr double kRoomRatio = 0.05;     // of a box's width that a first slack has at least
constexpr double kFirstProduct = 1e-2;  // complementarity at the start

using State = Eigen::Matrix<double, 5, 1>;

}  // namespace

RiccatiQp::RiccatiQp(int intervals)
    : stages_(static_cast<std::size_t>(intervals) + 1),
      sweeps_(static_cast<std::size_t>(intervals)),
      barriers_(static_cast<std::size_t>(intervals)),
      push_(static_cast<std::size_t>(intervals), Eigen::Array4d::Zero()),
      points_(static_cast<std::size_t>(intervals) + 1),
      newton_(static_cast<std::size_t>(intervals) + 1) {
  points_.back().u.setZero();
  newton_.back().u.setZero();
}

// The boxed numbers of stage k: its control, and speed and turn behind it.
Eigen::Array4d RiccatiQp::boxed(const std::vector<QpPoint>& points, int k) {
  const auto i = static_cast<std::size_t>(k);
  return {points[i].u(0), points[i].u(1), points[i + 1].x(3), points[i + 1].x(4)};
}

// Backwards: cost to go and feedback of every stage, with the barrier's weights in the Hessian.
void RiccatiQp::factorise() {
  Eigen::Matrix<double, 5, 5> value = stages_.back().q;
  for (int k = intervals() - 1; k >= 0; --k) {
    const auto i = static_cast<std::size_t>(k);
    const QpStage& stage = stages_[i];
    Sweep& sweep = sweeps_[i];
    value(3, 3) += sweep.weight(2);
    value(4, 4) += sweep.weight(3);
    sweep.value = value;
    const Eigen::Matrix<double, 5, 2> vb = value * stage.b;
    Eigen::Matrix2d hessian = stage.b.transpose() * vb;
    hessian(0, 0) += stage.r(0) + sweep.weight(0);
    hessian(1, 1) += stage.r(1) + sweep.weight(1);
    const Eigen::Matrix<double, 2, 5> cross = vb.transpose() * stage.a;
    const double det = hessian(0, 0) * hessian(1, 1) - hessian(0, 1) * hessian(1, 0);
    sweep.inverse << hessian(1, 1), -hessian(0, 1), -hessian(1, 0), hessian(0, 0);
    sweep.inverse /= det;
    sweep.gain = sweep.inverse * cross;
    const Eigen::Matrix<double, 5, 5> va = value * stage.a;
    value = stage.q;
    value.noalias() += stage.a.transpose() * va;
    value.noalias() -= cross.transpose() * sweep.gain;
    value = 0.5 * (value + value.transpose()).eval();
  }
}

// With the factors: the linear terms backwards, then the trajectory forwards.
void RiccatiQp::sweep(const State& start, std::vector<QpPoint>& to) {
  State slope = stages_.back().linear;
  for (int k = intervals() - 1; k >= 0; --k) {
    const auto i = static_cast<std::size_t>(k);
    const QpStage& stage = stages_[i];
    const Sweep& sweep = sweeps_[i];
    slope(3) += push_[i](2);
    slope(4) += push_[i](3);
    const State ahead = sweep.value * stage.c + slope;
    Eigen::Vector2d pull = stage.b.transpose() * ahead + stage.control_linear;
    pull += push_[i].head<2>().matrix();
    to[i].u = -(sweep.inverse * pull);  // the feed-forward; the feedback is added below
    slope = stage.linear + stage.a.transpose() * ahead - sweep.gain.transpose() * pull;
  }
  to[0].x = start;
  for (std::size_t i = 0; i < sweeps_.size(); ++i) {
    to[i].u -= sweeps_[i].gain * to[i].x;
    to[i + 1].x = stages_[i].a * to[i].x + stages_[i].b * to[i].u + stages_[i].c;
  }
}

bool RiccatiQp::within_bounds() const {
  for (int k = 0; k < intervals(); ++k) {
    const QpStage& stage = stages_[static_cast<std::size_t>(k)];
    const Eigen::Array4d z = boxed(points_, k);
    if (!((z >= stage.low).all() && (z <= stage.high).all())) return false;
  }
  return true;
}

void RiccatiQp::begin_interior() {
  for (int k = 0; k < intervals(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Eigen::Array4d z = boxed(points_, k);
    const Eigen::Array4d room = kRoomRatio * (stages_[i].high - stages_[i].low);
    Barrier& b = barriers_[i];
    b.low_slack = (z - stages_[i].low).max(room);
    b.high_slack = (stages_[i].high - z).max(room);
    b.low_price = kFirstProduct / b.low_slack;
    b.high_price = kFirstProduct / b.high_slack;
  }
}

void RiccatiQp::set_barrier_weights() {
  for (std::size_t i = 0; i < barriers_.size(); ++i) {
    const Barrier& b = barriers_[i];
    sweeps_[i].weight = b.low_price / b.low_slack + b.high_price / b.high_slack;
  }
}

// The linear terms of a Newton step towards the complementarity `target`; `correct` counts in what
// the predictor's own step would leave over.
void RiccatiQp::aim(double target, bool correct) {
  for (int k = 0; k < intervals(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Barrier& b = barriers_[i];
    const Eigen::Array4d z = boxed(points_, k);
    Eigen::Array4d low_target = Eigen::Array4d::Constant(target);
    Eigen::Array4d high_target = low_target;
    if (correct) {
      low_target -= b.low_step * b.low_price_step;
      high_target -= b.high_step * b.high_price_step;
    }
    const Eigen::Array4d low_miss = z - stages_[i].low - b.low_slack;
    const Eigen::Array4d high_miss = stages_[i].high - z - b.high_slack;
    push_[i] = -sweeps_[i].weight * z + (b.low_price * low_miss - low_target) / b.low_slack -
               (b.high_price * high_miss - high_target) / b.high_slack;
  }
  sweep(points_[0].x, newton_);
  for (int k = 0; k < intervals(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    Barrier& b = barriers_[i];
    const Eigen::Array4d z = boxed(newton_, k);
    Eigen::Array4d low_target = Eigen::Array4d::Constant(target);
    Eigen::Array4d high_target = low_target;
    if (correct) {
      low_target -= b.low_step * b.low_price_step;
      high_target -= b.high_step * b.high_price_step;
    }
    const Eigen::Array4d low_step = z - stages_[i].low - b.low_slack;
    const Eigen::Array4d high_step = stages_[i].high - z - b.high_slack;
    b.low_price_step = (low_target - b.low_price * low_step) / b.low_slack - b.low_price;
    b.high_price_step = (high_target - b.high_price * high_step) / b.high_slack - b.high_price;
    b.low_step = low_step;
    b.high_step = high_step;
  }
}

// The longest step along which slacks and prices stay positive, at most 1.
double RiccatiQp::longest_step() const {
  double worst = 1.0;  // of -step / value; the step is its inverse
  for (const Barrier& b : barriers_) {
    worst = std::max(worst, (-b.low_step / b.low_slack).maxCoeff());
    worst = std::max(worst, (-b.high_step / b.high_slack).maxCoeff());
    worst = std::max(worst, (-b.low_price_step / b.low_price).maxCoeff());
    worst = std::max(worst, (-b.high_price_step / b.high_price).maxCoeff());
  }
  return 1.0 / worst;
}

// Mean of slack times price after a step.
double RiccatiQp::mean_product(double step) const {
  double sum = 0.0;
  for (const Barrier& b : barriers_) {
    sum += ((b.low_slack + step * b.low_step) * (b.low_price + step * b.low_price_step)).sum();
    sum += ((b.high_slack + step * b.high_step) * (b.high_price + step * b.high_price_step)).sum();
  }
  return sum / (8.0 * intervals());
}

void RiccatiQp::take_step(double step) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    points_[i].x += step * (newton_[i].x - points_[i].x);
    points_[i].u += step * (newton_[i].u - points_[i].u);
  }
  for (Barrier& b : barriers_) {
    b.low_slack += step * b.low_step;
    b.high_slack += step * b.high_step;
    b.low_price += step * b.low_price_step;
    b.high_price += step * b.high_price_step;
  }
}

bool RiccatiQp::solve(const State& start, const QpOptions& options) {
  for (std::size_t i = 0; i < sweeps_.size(); ++i) {
    sweeps_[i].weight.setZero();
    push_[i].setZero();
  }
  iterations_ = 0;
  factorise();
  sweep(start, points_);
  if (!points_.back().x.allFinite()) return false;
  if (within_bounds()) return true;
  begin_interior();
  double infeasible = 1.0;  // share of the first slacks' misfit that is left
  for (; iterations_ < options.most_iterations; ++iterations_) {
    for (Barrier& b : barriers_) {
      b.low_step = b.high_step = b.low_price_step = b.high_price_step = Eigen::Array4d::Zero();
    }
    const double product = mean_product(0.0);
    if (product < options.tolerance && infeasible < options.tolerance) break;
    set_barrier_weights();
    factorise();
    aim(0.0, false);
    const double affine = mean_product(longest_step());
    const double ratio = affine / product;
    aim(ratio * ratio * ratio * product, true);
    const double longest = longest_step();
    const double step = longest < 1.0 ? kToBoundary * longest : 1.0;
    take_step(step);
    infeasible *= 1.0 - step;
  }
  return points_.back().x.allFinite() && infeasible < 0.5;
}

}  // namespace headland::control::internal
