// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "global_planner/tour/row_tour.hpp"

namespace headland::tour {

/// More rows than this are never solved exactly: 20 rows take 336 MB and about a second.
inline constexpr int kMaxExactRows = 20;

/// The cheapest order of all rows by dynamic programming over (set of rows, last row, side)
/// (Bellman 1962, Held and Karp 1962). Empty if there is none. Requires rows() in
/// 1..kMaxExactRows. O(2^n n^2) time, 2^n * 2 n doubles.
std::vector<RowVisit> held_karp(const RowTourProblem& problem);

}  // namespace headland::tour
