// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/internal/tracking_nlp.hpp"

#include <algorithm>
#include <cmath>

namespace headland::control::internal {
namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr int kBlock = 7;  // variables an interval: the control, then the state behind it
constexpr double kUnbounded = 2e19;

// Where x_k (k > 0) and u_k begin among the variables.
int state_at(int k) { return kBlock * (k - 1) + 2; }
int control_at(int k) { return kBlock * k; }

// Every interval's constraints touch x_k (not for k = 0) and u_k with a full block, and x_{k+1}.
int jacobian_entries(int intervals) { return intervals * (5 * 2 + 5) + (intervals - 1) * 5 * 5; }
// Lower triangles: of x_k and u_k together, of x_N alone, and of u_0 alone.
int hessian_entries(int intervals) { return (intervals - 1) * 28 + 15 + 3; }

// Of stage k > 0, the variable of row i of (x, u).
int joint_at(int k, int i) { return i < 5 ? state_at(k) + i : control_at(k) + i - 5; }

}  // namespace

TrackingNlp::TrackingNlp(int intervals)
    : intervals_(intervals),
      plan_(intervals),
      low_price_(static_cast<std::size_t>(kBlock * intervals), 1.0),
      high_price_(low_price_),
      multipliers_(static_cast<std::size_t>(5 * intervals), 0.0) {}

void TrackingNlp::set(const HorizonProblem& problem, const HorizonPlan& guess,
                      const Deadline& deadline) {
  problem_ = &problem;
  plan_ = guess;
  deadline_ = deadline;
  timed_out_ = false;
  has_plan_ = false;
}

HorizonState TrackingNlp::state(const Number* x, int k) const {
  if (k == 0) return problem_->start;
  return Eigen::Map<const HorizonState>(x + state_at(k));
}

HorizonControl TrackingNlp::control(const Number* x, int k) const {
  return Eigen::Map<const HorizonControl>(x + control_at(k));
}

bool TrackingNlp::get_nlp_info(Index& n, Index& m, Index& nnz_jac_g, Index& nnz_h_lag,
                               IndexStyleEnum& index_style) {
  n = kBlock * intervals_;
  m = 5 * intervals_;
  nnz_jac_g = jacobian_entries(intervals_);
  nnz_h_lag = hessian_entries(intervals_);
  index_style = C_STYLE;
  return true;
}

bool TrackingNlp::get_bounds_info(Index n, Number* x_l, Number* x_u, Index m, Number* g_l,
                                  Number* g_u) {
  std::fill_n(x_l, n, -kUnbounded);
  std::fill_n(x_u, n, kUnbounded);
  std::fill_n(g_l, m, 0.0);
  std::fill_n(g_u, m, 0.0);
  const auto box = [&](int at, const Bounds& bounds) {
    x_l[at] = bounds.low;
    x_u[at] = bounds.high;
  };
  for (int k = 0; k < intervals_; ++k) {
    box(control_at(k), problem_->acceleration);
    box(control_at(k) + 1, problem_->turn_rate);
    box(state_at(k + 1) + kWheelSpeed, problem_->stage(k + 1).speed);
    box(state_at(k + 1) + kWheelTurn, problem_->stage(k + 1).turn);
  }
  return true;
}

bool TrackingNlp::get_starting_point(Index n, bool init_x, Number* x, bool init_z, Number* z_l,
                                     Number* z_u, Index m, bool init_lambda, Number* lambda) {
  if (init_x) {
    for (int k = 0; k < intervals_; ++k) {
      const auto i = static_cast<std::size_t>(k);
      Eigen::Map<HorizonControl>(x + control_at(k)) = plan_.controls[i];
      Eigen::Map<HorizonState>(x + state_at(k + 1)) = plan_.states[i + 1];
    }
  }
  if (init_z) {
    std::copy_n(low_price_.begin(), n, z_l);
    std::copy_n(high_price_.begin(), n, z_u);
  }
  if (init_lambda) std::copy_n(multipliers_.begin(), m, lambda);
  return true;
}

bool TrackingNlp::eval_f(Index, const Number* x, bool, Number& value) {
  value = 0.0;
  for (int k = 0; k <= intervals_; ++k) {
    const HorizonState off = state(x, k) - problem_->stage(k).wanted;
    value += 0.5 * off.dot(problem_->state_weight(k) * off);
    if (k == intervals_) break;
    const HorizonControl push = control(x, k) - problem_->stage(k).control;
    value += 0.5 * push.dot(problem_->control_weight().cwiseProduct(push));
  }
  return std::isfinite(value);
}

bool TrackingNlp::eval_grad_f(Index, const Number* x, bool, Number* gradient) {
  for (int k = 0; k <= intervals_; ++k) {
    if (k > 0) {
      Eigen::Map<HorizonState>(gradient + state_at(k)) =
          problem_->state_weight(k) * (state(x, k) - problem_->stage(k).wanted);
    }
    if (k == intervals_) break;
    Eigen::Map<HorizonControl>(gradient + control_at(k)) =
        problem_->control_weight().cwiseProduct(control(x, k) - problem_->stage(k).control);
  }
  return true;
}

bool TrackingNlp::eval_g(Index, const Number* x, bool, Index, Number* g) {
  for (int k = 0; k < intervals_; ++k) {
    Eigen::Map<HorizonState>(g + 5 * k) =
        problem_->next(state(x, k), control(x, k)) - state(x, k + 1);
  }
  return true;
}

bool TrackingNlp::eval_jac_g(Index, const Number* x, bool, Index, Index, Index* rows,
                             Index* columns, Number* values) {
  int entry = 0;
  HorizonProblem::StateMatrix by_state;
  HorizonProblem::ControlMatrix by_control;
  for (int k = 0; k < intervals_; ++k) {
    if (values != nullptr) problem_->next(state(x, k), control(x, k), by_state, by_control);
    const auto put = [&](int row, int column, double value) {
      if (values == nullptr) {
        rows[entry] = 5 * k + row;
        columns[entry] = column;
      } else {
        values[entry] = value;
      }
      ++entry;
    };
    for (int row = 0; row < 5; ++row) {
      for (int i = 0; k > 0 && i < 5; ++i) put(row, state_at(k) + i, by_state(row, i));
      for (int i = 0; i < 2; ++i) put(row, control_at(k) + i, by_control(row, i));
      put(row, state_at(k + 1) + row, -1.0);
    }
  }
  return true;
}

bool TrackingNlp::eval_h(Index, const Number* x, bool, Number factor, Index, const Number* lambda,
                         bool, Index, Index* rows, Index* columns, Number* values) {
  int entry = 0;
  Eigen::Matrix<double, 7, 7> block = Eigen::Matrix<double, 7, 7>::Zero();
  for (int k = 0; k <= intervals_; ++k) {
    if (values != nullptr) {
      block.setZero();
      if (k < intervals_) {
        block = problem_->curvature(state(x, k), control(x, k),
                                    Eigen::Map<const HorizonState>(lambda + 5 * k));
        block.diagonal().tail<2>() += factor * problem_->control_weight();
      }
      block.topLeftCorner<5, 5>() += factor * problem_->state_weight(k);
    }
    const int first = k == 0 ? 5 : 0;
    const int last = k == intervals_ ? 5 : 7;
    for (int i = first; i < last; ++i) {
      for (int j = first; j <= i; ++j, ++entry) {
        if (values == nullptr) {
          const int a = k == 0 ? control_at(0) + i - 5 : joint_at(k, i);
          const int b = k == 0 ? control_at(0) + j - 5 : joint_at(k, j);
          rows[entry] = std::max(a, b);
          columns[entry] = std::min(a, b);
        } else {
          values[entry] = block(i, j);
        }
      }
    }
  }
  return true;
}

bool TrackingNlp::intermediate_callback(Ipopt::AlgorithmMode, Index, Number, Number, Number, Number,
                                        Number, Number, Number, Number, Index,
                                        const Ipopt::IpoptData*,
                                        Ipopt::IpoptCalculatedQuantities*) {
  timed_out_ = deadline_.passed();
  return !timed_out_;
}

void TrackingNlp::finalize_solution(Ipopt::SolverReturn, Index n, const Number* x,
                                    const Number* z_l, const Number* z_u, Index m, const Number*,
                                    const Number* lambda, Number, const Ipopt::IpoptData*,
                                    Ipopt::IpoptCalculatedQuantities*) {
  if (!std::all_of(x, x + n, [](double value) { return std::isfinite(value); })) return;
  plan_.states[0] = problem_->start;
  for (int k = 0; k < intervals_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    plan_.controls[i] = control(x, k);
    plan_.states[i + 1] = state(x, k + 1);
  }
  std::copy_n(z_l, n, low_price_.begin());
  std::copy_n(z_u, n, high_price_.begin());
  std::copy_n(lambda, m, multipliers_.begin());
  has_plan_ = true;
}

}  // namespace headland::control::internal
