// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/base/result.hpp"
#include "global_planner/tour/tour_problem.hpp"

namespace headland {

struct TourOptions {
  std::uint64_t seed = 1;
  int exact_up_to_tasks = 15;  ///< up to this many tasks all solutions are searched, if time allows
  /// Rounds of ruin and recreate; 0: a number that suits the size.
  long iterations = 0;
  /// Asked now and then; true ends the search, with the best found. For live budgets: this library
  /// reads no clock.
  std::function<bool()> stop;
  /// Called now and then with the share of the work that is done and the best cost, for progress.
  std::function<void(double fraction, double best_cost)> progress;
};

/// The cheapest tours found. Deterministic for a seed where `stop` is not used. Errors:
/// kEnergyInfeasible, kNoPath or kTaskDoesNotFit name the first task ("task 4") that must be done
/// and that no vehicle can do, with the reason.
Result<TourSolution> solve_tour(const TourProblem& problem, const TourOptions& options = {});

/// Checks a solution against the problem, from the stops alone and independently of the solver:
/// every leg, charge, window, load, slot, reserve and the cost. The first thing that is wrong, or
/// nothing.
std::optional<std::string> check_solution(const TourProblem& problem, const TourSolution& solution);

}  // namespace headland
