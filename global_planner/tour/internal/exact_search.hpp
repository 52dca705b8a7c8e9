// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "global_planner/tour/internal/model.hpp"

namespace headland::tour {

/// Who does what, in which order; times and charges follow from it.
struct PlannedRoute {
  int kind = 0;
  std::vector<Visit> visits;
};

struct ExactLimits {
  double upper_bound = kNever;  ///< only what is cheaper is of interest
  long effort = 0;              ///< labels to work on at most
  std::function<bool()> stop;
};

struct ExactAnswer {
  bool complete = false;             ///< the search ended by itself: `cost` is a lower bound
  double cost = kNever;              ///< of the best; upper_bound if nothing is cheaper
  std::vector<PlannedRoute> routes;  ///< empty if nothing is cheaper than the upper bound
};

/// The cheapest tours by dynamic programming: the cheapest routes for every set of tasks, by labels
/// over (set, last task and mode) in the order of growing sets, then the cheapest way to share the
/// tasks among the vehicles. Queues at stations are not looked at (they only make things dearer).
/// For up to about 15 tasks; at most 20.
ExactAnswer exact_search(const Model& model, const ExactLimits& limits);

}  // namespace headland::tour
