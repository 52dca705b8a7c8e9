// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "global_planner/tour/internal/cycle_prices.hpp"

namespace headland::tour {

double tour_length(const CostMatrix& costs, const Successors& next);

struct TreeSearch {
  long most_nodes = 0;
  std::size_t most_memory_bytes = 256U << 20U;  ///< of open nodes
  bool whole_costs = false;                     ///< all costs are whole numbers
  std::function<bool()> stop;                   ///< may be empty
  std::function<void(double cost)> improved;    ///< may be empty
};

struct TreeAnswer {
  Successors next;  ///< the best tour known
  double cost = 0.0;
  double lower_bound = 0.0;  ///< no tour costs less
};

/// Shortest tour by branch and bound over assignments (Carpaneto, Dell'Amico and Toth 1995): a
/// node's bound is its cheapest assignment; where that falls into several cycles, one of them is
/// broken at each of its arcs in turn. Nodes by least bound first. Cycles are also patched into
/// tours (Karp 1979). Bounds count `priced` costs. Starts from a known tour (may be empty).
TreeAnswer search_assignments(const CostMatrix& costs, const PricedCosts& priced,
                              const Successors& known, const TreeSearch& limits);

}  // namespace headland::tour
