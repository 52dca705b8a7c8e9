// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/ipopt_solver.hpp"

#include <mutex>

#include <coin/IpIpoptApplication.hpp>
#include <coin/IpSolveStatistics.hpp>

#include "control/receding_horizon/internal/tracking_nlp.hpp"

namespace headland {
namespace {

// MUMPS 5.5 keeps load statistics in globals: two threads that factorise at once crash.
std::mutex& mumps_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

struct IpoptSolver::Impl {
  Impl(int intervals, const IpoptOptions& given)
      : options(given), nlp(new control::internal::TrackingNlp(intervals)) {
    const std::lock_guard lock(mumps_mutex());
    app = new Ipopt::IpoptApplication(false);  // no console
    const auto set = app->Options();
    set->SetIntegerValue("print_level", 0);
    set->SetStringValue("sb", "yes");
    set->SetNumericValue("tol", options.tolerance);
    set->SetIntegerValue("max_iter", options.most_iterations);
    set->SetStringValue("nlp_scaling_method", "none");
    set->SetIntegerValue("mumps_pivot_order", 0);
    set->SetIntegerValue("min_refinement_steps", 0);
    for (const char* push :
         {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_slack_bound_push",
          "warm_start_slack_bound_frac", "warm_start_mult_bound_push"}) {
      set->SetNumericValue(push, 1e-6);
    }
    initialised = app->Initialize() == Ipopt::Solve_Succeeded;
  }

  void start_warm(bool warm) {
    const auto set = app->Options();
    set->SetStringValue("warm_start_init_point", warm ? "yes" : "no");
    set->SetNumericValue("mu_init", warm ? options.first_barrier : 0.1);
  }

  IpoptOptions options;
  Ipopt::SmartPtr<control::internal::TrackingNlp> nlp;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> app;
  bool initialised = false;
  bool has_structure = false;
  bool has_multipliers = false;
};

IpoptSolver::IpoptSolver(int intervals, const IpoptOptions& options)
    : impl_(std::make_unique<Impl>(intervals, options)) {}

IpoptSolver::~IpoptSolver() {
  const std::lock_guard lock(mumps_mutex());
  impl_.reset();
}

SolveResult IpoptSolver::solve(const HorizonProblem& problem, HorizonPlan& plan,
                               const Deadline& deadline) {
  if (!impl_->initialised || !problem.start.allFinite()) return {SolveStatus::kFailed, 0};
  const std::lock_guard lock(mumps_mutex());
  if (deadline.passed()) return {SolveStatus::kTimedOut, 0};
  impl_->nlp->set(problem, plan, deadline);
  impl_->start_warm(impl_->options.warm && impl_->has_multipliers);
  Ipopt::ApplicationReturnStatus status = Ipopt::Internal_Error;
  try {
    status = impl_->has_structure ? impl_->app->ReOptimizeTNLP(GetRawPtr(impl_->nlp))
                                  : impl_->app->OptimizeTNLP(GetRawPtr(impl_->nlp));
  } catch (...) {
    status = Ipopt::Unrecoverable_Exception;
  }
  impl_->has_structure = true;
  SolveResult result;
  if (IsValid(impl_->app->Statistics())) {
    result.iterations = impl_->app->Statistics()->IterationCount();
  }
  const bool optimal =
      status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level;
  if (impl_->nlp->timed_out()) {
    result.status = SolveStatus::kTimedOut;
  } else if ((optimal || status == Ipopt::Maximum_Iterations_Exceeded) && impl_->nlp->has_plan()) {
    result.status = optimal ? SolveStatus::kOptimal : SolveStatus::kUsable;
    plan = impl_->nlp->plan();
  }
  impl_->has_multipliers = solved(result.status);
  return result;
}

}  // namespace headland
