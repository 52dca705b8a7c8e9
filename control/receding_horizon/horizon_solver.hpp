// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/receding_horizon/horizon_problem.hpp"
#include "core/base/clock.hpp"

namespace headland {

enum class SolveStatus {
  kOptimal,   ///< converged to the solver's tolerance
  kUsable,    ///< the iterations allowed are used up; the plan keeps bounds and nearly the dynamics
  kTimedOut,  ///< the deadline passed; the plan is as it was given
  kFailed     ///< no plan; it is as it was given
};

constexpr bool solved(SolveStatus status) { return status <= SolveStatus::kUsable; }

struct SolveResult {
  SolveStatus status = SolveStatus::kFailed;
  int iterations = 0;
};

/// Solves horizon problems of one size, one after the other. Not thread-safe; several solvers may
/// run in threads of their own.
class HorizonSolver {
 public:
  virtual ~HorizonSolver() = default;
  /// Improves `plan`, which is at first a guess, best the last problem's plan shifted. Its states
  /// need not obey the dynamics.
  virtual SolveResult solve(const HorizonProblem& problem, HorizonPlan& plan,
                            const Deadline& deadline) = 0;
};

}  // namespace headland
