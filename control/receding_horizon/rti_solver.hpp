// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "control/receding_horizon/horizon_solver.hpp"

namespace headland {

struct RtiOptions {
  /// Quadratic programmes per solve: 1 is the real-time iteration (Diehl, Bock, Schloeder 2005);
  /// many converge.
  int most_iterations = 1;
  /// Converged when no state and no control changes by more than this.
  double tolerance = 1e-9;
  /// Complementarity of the quadratic programmes.
  double qp_tolerance = 1e-6;
};

/// Gauss-Newton SQP: the dynamics are linearised around the plan, the resulting quadratic programme
/// is solved by a Riccati recursion (with an interior-point method where bounds bind), and the plan
/// takes the full step. The cost is quadratic, so that only the dynamics' curvature is left out.
/// solve() does not allocate; problems must have the number of intervals given here.
class RtiSolver : public HorizonSolver {
 public:
  explicit RtiSolver(int intervals, const RtiOptions& options = {});
  ~RtiSolver() override;
  SolveResult solve(const HorizonProblem& problem, HorizonPlan& plan,
                    const Deadline& deadline) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace headland
