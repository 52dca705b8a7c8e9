// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "global_planner/tour/internal/assignment_tree.hpp"
#include "global_planner/tour/row_tour.hpp"

namespace headland::tour {

struct OneWaySearch {
  std::uint64_t seed = 1;
  int iterations = 0;          ///< local-search kicks; 0: a number that suits the size
  std::function<bool()> stop;  ///< may be empty
  std::function<void(double cost)> improved;  ///< may be empty
};

/// The cheapest order of rows of which each can be entered at its first end only (an asymmetric
/// travelling salesman): assignments alone at first, which settle most problems of many equal
/// costs; then local search, prices for cycles, and the assignments' tree again. The last node of
/// the answer is the depot. Infinite cost: none was found; infinite bound: there is none.
/// Deterministic for a seed if never stopped.
TreeAnswer one_way_tour(const RowTourProblem& problem, const OneWaySearch& search);

}  // namespace headland::tour
