// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "global_planner/tour/tour_solver.hpp"

namespace headland::tour {

/// All tasks in one order, as one vehicle drives them if nothing limits it.
struct OrderAnswer {
  std::vector<std::pair<int, int>> visits;  ///< task, mode
  double cost = 0.0;                        ///< the objective, times weighed in, nothing left out
  double lower_bound = 0.0;                 ///< no order of all tasks costs less
  bool optimal = false;
};

/// The cheapest order of all tasks of a problem with one vehicle and one or two modes a task.
/// Batteries, windows, loads and rewards are ignored: where there are none the answer is the
/// problem's. Nothing if the problem has another shape, or no order was found. Deterministic for a
/// seed where `stop` is not used.
std::optional<OrderAnswer> solve_order(const TourProblem& problem, const TourOptions& options);

}  // namespace headland::tour
