// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "global_planner/tour/internal/assignment.hpp"

namespace headland::tour {

/// Costs made cheaper by prices for leaving sets of nodes: every tour leaves each set, so that
/// `offset` (the prices' sum) plus its length by these costs is no more than its true length.
struct PricedCosts {
  CostMatrix costs;
  double offset = 0.0;
  double bound = 0.0;  ///< offset and the cheapest assignment: no tour is shorter
};

/// Prices for the cycles that assignments fall into, by subgradient ascent (Lagrangian relaxation
/// of the subtour constraints, Balas and Christofides 1981). `target` is some tour's length. At
/// most `rounds` assignments are made.
PricedCosts price_cycles(const CostMatrix& costs, double target, int rounds,
                         const std::function<bool()>& stop);

}  // namespace headland::tour
