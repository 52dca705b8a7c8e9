// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <vector>

namespace headland {

/// What it costs to pair each row with each column. Infinity, or no number, forbids the pair.
class PairCosts {
 public:
  /// All pairs forbidden. Reuses its memory.
  void reset(int rows, int columns) {
    rows_ = rows;
    columns_ = columns;
    cost_.assign(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns),
                 std::numeric_limits<double>::infinity());
  }
  int rows() const { return rows_; }
  int columns() const { return columns_; }
  double& at(int row, int column) { return cost_[place(row, column)]; }
  double at(int row, int column) const { return cost_[place(row, column)]; }

 private:
  std::size_t place(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  int rows_ = 0;
  int columns_ = 0;
  std::vector<double> cost_;
};

/// Pairs rows with columns, each at most once, so that the costs of the pairs have the least sum;
/// whoever stays alone costs nothing. So only pairs that cost less than 0 can be worth it: to get
/// as many pairs as there can be, take something large off all costs.
///
/// Row by row the cheapest augmenting path, by Dijkstra over reduced costs (Tomizawa 1971; Jonker
/// and Volgenant 1987). Deterministic. O(rows^2 columns); does not allocate once it has held as
/// many. One object per thread.
class PairAssignment {
 public:
  /// Column of each row, -1: none. Valid until the next call.
  std::span<const int> solve(const PairCosts& costs);
  /// Row of each column, -1: none.
  std::span<const int> row_of() const { return row_of_; }

 private:
  void add_row(const PairCosts& costs, int row);
  // Takes the columns along the path that ended at `column` (or with `row` giving its column up).
  void follow_back(int row, int column);

  std::vector<int> column_of_;
  std::vector<int> row_of_;
  std::vector<double> row_price_;
  std::vector<double> column_price_;
  // Of the path being searched.
  std::vector<double> distance_;  // to columns
  std::vector<int> from_;         // row before a column
  std::vector<char> done_;        // columns
};

}  // namespace headland
