// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/base/result.hpp"

namespace headland {

/// Order and direction of rows. Row r has two ends: 2 r (its first point) and 2 r + 1 (its last).
/// Every row is entered at one end and left at the other.
struct RowTourProblem {
  /// (2n x 2n): transition(e, f) is the cost of leaving a row by end e and entering another by end
  /// f; infinity where there is no way. Entries within one row are unused. Need not be symmetric.
  Eigen::MatrixXd transition;
  Eigen::VectorXd start;   ///< 2n: from the start to entering by end f
  Eigen::VectorXd finish;  ///< 2n: from leaving by end e to the finish

  int rows() const { return static_cast<int>(start.size()) / 2; }
};

struct RowVisit {
  int row = 0;
  int entry = 0;  ///< end by which it is entered: 0 or 1

  int entry_end() const { return 2 * row + entry; }
  int exit_end() const { return 2 * row + 1 - entry; }
};

struct RowTour {
  std::vector<RowVisit> visits;
  double cost = 0.0;         ///< start, transitions and finish; the rows themselves not counted
  double lower_bound = 0.0;  ///< no tour of this problem costs less
  bool optimal = false;      ///< proven
};

struct RowTourOptions {
  std::uint64_t seed = 1;
  int iterations = 0;            ///< local-search kicks; 0: a number that suits the size
  std::function<bool()> stop{};  ///< asked now and then; true ends the local search
  int exact_up_to_rows = 16;     ///< taken as 3..20: memory doubles with every row, 336 MB at 20
};

/// The cheapest order of rows: exact up to `exact_up_to_rows` (Held and Karp 1962 over row and
/// side), above that seeded local search with a Held-Karp 1-tree lower bound. Deterministic for a
/// seed. Error kNoPath names the first row that cannot be reached.
Result<RowTour> solve_row_tour(const RowTourProblem& problem, const RowTourOptions& options = {});

/// Cost of a given order; infinity if it uses a transition that does not exist.
double tour_cost(const RowTourProblem& problem, const std::vector<RowVisit>& visits);

}  // namespace headland
