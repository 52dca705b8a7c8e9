// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace headland::control::internal {

/// The linear-quadratic problem of one horizon, with boxes on the controls and on the last two
/// states:
///   min  sum_k x_k' Q_k x_k / 2 + q_k' x_k + u_k' R u_k / 2 + r_k' u_k
///   s.t. x_{k+1} = A_k x_k + B_k u_k + c_k,  x_0 given,  low_k <= (u_k, last two of x_{k+1}) <=
///   high_k
struct QpStage {
  Eigen::Matrix<double, 5, 5> a;
  Eigen::Matrix<double, 5, 2> b;
  Eigen::Matrix<double, 5, 1> c;
  Eigen::Matrix<double, 5, 5> q;
  Eigen::Matrix<double, 5, 1> linear;
  Eigen::Vector2d r;  // diagonal
  Eigen::Vector2d control_linear;
  Eigen::Array4d low;
  Eigen::Array4d high;
};

struct QpPoint {
  Eigen::Matrix<double, 5, 1> x;
  Eigen::Vector2d u;
};

struct QpOptions {
  double tolerance = 1e-6;  ///< of the complementarity, over the weights' own size
  int most_iterations = 30;
};

/// Solves it by a Riccati recursion; where that breaks a bound, by Mehrotra's predictor-corrector
/// interior-point method, whose every Newton step is such a recursion. Fixed sizes: no allocation
/// after construction.
class RiccatiQp {
 public:
  explicit RiccatiQp(int intervals);

  /// Stage k < intervals, and the last one, of which only q and linear count. To be filled before
  /// solve().
  QpStage& stage(int k) { return stages_[static_cast<std::size_t>(k)]; }

  /// False if it did not converge to finite numbers.
  bool solve(const Eigen::Matrix<double, 5, 1>& start, const QpOptions& options);
  const QpPoint& point(int k) const { return points_[static_cast<std::size_t>(k)]; }
  int iterations() const { return iterations_; }  ///< of the interior-point method

 private:
  // Slacks to both bounds, and their multipliers, of one stage's boxes.
  struct Barrier {
    Eigen::Array4d low_slack, high_slack, low_price, high_price;
    Eigen::Array4d low_step, high_step, low_price_step, high_price_step;  // Newton's
  };
  struct Sweep {
    Eigen::Matrix<double, 2, 5> gain;
    Eigen::Matrix<double, 2, 2> inverse;  // of the controls' Hessian
    Eigen::Matrix<double, 5, 5> value;    // cost to go
    Eigen::Array4d weight;                // of the barrier
  };

  int intervals() const { return static_cast<int>(barriers_.size()); }
  void factorise();
  void sweep(const Eigen::Matrix<double, 5, 1>& start, std::vector<QpPoint>& to);
  bool within_bounds() const;
  void begin_interior();
  void set_barrier_weights();
  void aim(double target, bool correct);
  double longest_step() const;
  double mean_product(double step) const;
  void take_step(double step);
  static Eigen::Array4d boxed(const std::vector<QpPoint>& points, int k);

  std::vector<QpStage> stages_;
  std::vector<Sweep> sweeps_;
  std::vector<Barrier> barriers_;
  std::vector<Eigen::Array4d> push_;  // linear term of the barrier
  std::vector<QpPoint> points_;
  std::vector<QpPoint> newton_;  // where the Newton step leads
  int iterations_ = 0;
};

}  // namespace headland::control::internal
