// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "global_planner/tour/internal/cycle.hpp"

namespace headland::tour {

/// A lower bound on every tour, and what its ascent learnt about which edges good tours use.
struct TreeBound {
  /// Infinity if the rows do not hang together (a proof that no tour exists); else rounded down.
  double bound = 0.0;
  Neighbours neighbours;
};

/// Held-Karp bound of the cycle: Lagrangian relaxation of "one edge at every row end" to a spanning
/// tree over the rows plus one edge at the start and one at the finish, raised by subgradient
/// ascent (Held and Karp 1970, 1971), with odd-set (blossom) inequalities found on the way.
/// `upper_bound` (any tour's cost, or infinity) only sets the step. Directed costs count with their
/// cheaper direction. Deterministic.
TreeBound one_tree_bound(const Cycle& cycle, double upper_bound);

}  // namespace headland::tour
