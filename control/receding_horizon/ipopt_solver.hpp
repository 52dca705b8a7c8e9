// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "control/receding_horizon/horizon_solver.hpp"

namespace headland {

struct IpoptOptions {
  double tolerance = 1e-4;
  int most_iterations = 15;
  /// Start from the last solution's multipliers, shifted by what the plan was shifted.
  bool warm = true;
  double first_barrier = 1e-4;  ///< of warm starts
};

/// The reference solver: Ipopt (Waechter and Biegler 2006) with exact Jacobian and Hessian.
/// Its linear solver, MUMPS, has state of its own process-wide: solves of all threads queue at one
/// mutex. Allocates in every solve.
class IpoptSolver : public HorizonSolver {
 public:
  explicit IpoptSolver(int intervals, const IpoptOptions& options = {});
  ~IpoptSolver() override;
  SolveResult solve(const HorizonProblem& problem, HorizonPlan& plan,
                    const Deadline& deadline) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace headland
