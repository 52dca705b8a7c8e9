// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/rti_solver.hpp"

#include <algorithm>
#include <utility>

#include "control/receding_horizon/internal/riccati_qp.hpp"

namespace headland {

struct RtiSolver::Impl {
  Impl(int intervals, const RtiOptions& given)
      : options(given), qp(intervals), candidate(intervals) {}

  RtiOptions options;
  control::internal::RiccatiQp qp;
  HorizonPlan candidate;

  // The quadratic programme in the changes of the plan's states and controls.
  void linearise(const HorizonProblem& problem, const HorizonPlan& plan) {
    const int n = problem.intervals();
    for (int k = 0; k <= n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      control::internal::QpStage& stage = qp.stage(k);
      const HorizonStage& wanted = problem.stage(k);
      stage.q = problem.state_weight(k);
      stage.linear = stage.q * (plan.states[i] - wanted.wanted);
      if (k == n) break;
      const HorizonState& after = plan.states[i + 1];
      stage.c = problem.next(plan.states[i], plan.controls[i], stage.a, stage.b) - after;
      stage.r = problem.control_weight();
      stage.control_linear = stage.r.cwiseProduct(plan.controls[i] - wanted.control);
      const HorizonStage& next = problem.stage(k + 1);
      const Eigen::Array4d now(plan.controls[i](0), plan.controls[i](1), after(kWheelSpeed),
                               after(kWheelTurn));
      stage.low << problem.acceleration.low, problem.turn_rate.low, next.speed.low, next.turn.low;
      stage.high << problem.acceleration.high, problem.turn_rate.high, next.speed.high,
          next.turn.high;
      stage.low -= now;
      stage.high -= now;
    }
  }

  // Adds the programme's solution to the plan; returns the largest change.
  double take_step(HorizonPlan& plan) {
    double largest = 0.0;
    for (std::size_t i = 0; i < plan.states.size(); ++i) {
      const control::internal::QpPoint& change = qp.point(static_cast<int>(i));
      plan.states[i] += change.x;
      largest = std::max(largest, change.x.cwiseAbs().maxCoeff());
      if (i == plan.controls.size()) break;
      plan.controls[i] += change.u;
      largest = std::max(largest, change.u.cwiseAbs().maxCoeff());
    }
    return largest;
  }
};

RtiSolver::RtiSolver(int intervals, const RtiOptions& options)
    : impl_(std::make_unique<Impl>(intervals, options)) {}
RtiSolver::~RtiSolver() = default;

SolveResult RtiSolver::solve(const HorizonProblem& problem, HorizonPlan& plan,
                             const Deadline& deadline) {
  HorizonPlan& next = impl_->candidate;
  std::copy(plan.states.begin(), plan.states.end(), next.states.begin());
  std::copy(plan.controls.begin(), plan.controls.end(), next.controls.begin());
  SolveResult result{SolveStatus::kUsable, 0};
  while (result.iterations < impl_->options.most_iterations) {
    impl_->linearise(problem, next);
    const HorizonState start = problem.start - next.states[0];
    if (!impl_->qp.solve(start, {impl_->options.qp_tolerance})) {
      return {SolveStatus::kFailed, result.iterations};
    }
    ++result.iterations;
    const bool converged = impl_->take_step(next) < impl_->options.tolerance;
    if (deadline.passed()) return {SolveStatus::kTimedOut, result.iterations};
    if (converged) {
      result.status = SolveStatus::kOptimal;
      break;
    }
  }
  std::swap(plan.states, next.states);
  std::swap(plan.controls, next.controls);
  return result;
}

}  // namespace headland
