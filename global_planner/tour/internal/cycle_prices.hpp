// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "global_planner/tour/internal/assignment.hpp"

namespace headland::tour {

/// Costs made cheaper by prices for leaving sets of nodes: every tour leaves each set as often as
/// it must, so that `offset` (the prices' sum, each that often) plus its length by these costs is
/// no more than its true length.
struct PricedCosts {
  CostMatrix costs;
  double offset = 0.0;
  double bound = 0.0;  ///< offset and the cheapest assignment: no tour is shorter
};

/// A set of nodes that every solution must leave. Where its `keeper` (-1: none) may be left out, an
/// arc from the keeper to itself counts as leaving.
struct LeavingRule {
  std::vector<int> inside;
  int times = 1;
  int keeper = -1;
};

struct PriceAscent {
  double reach = 0.0;  ///< about how far the bound may rise; sets the steps
  int rounds = 0;      ///< at most so many assignments
  std::function<bool()> stop;
  /// Rules that an assignment's cycle breaks, or may break. Empty: it must be left once.
  std::function<void(const std::vector<int>& cycle, std::vector<LeavingRule>& rules)> rules;
};

/// Prices for rules that assignments break, by subgradient ascent (Lagrangian relaxation of the
/// subtour constraints, Balas and Christofides 1981).
PricedCosts price_cycles(const CostMatrix& costs, const PriceAscent& ascent);

}  // namespace headland::tour
