// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/assignment.hpp"

#include <cmath>

namespace headland {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

std::span<const int> PairAssignment::solve(const PairCosts& costs) {
  column_of_.assign(at(costs.rows()), -1);
  row_of_.assign(at(costs.columns()), -1);
  row_price_.assign(at(costs.rows()), 0.0);
  column_price_.assign(at(costs.columns()), 0.0);
  for (int row = 0; row < costs.rows(); ++row) add_row(costs, row);
  return column_of_;
}

// Each row has, beside the columns, a place of its own that costs nothing: staying alone. The
// shortest path from the new row ends at a free column, or at the place of its own of a row on it.
void PairAssignment::add_row(const PairCosts& costs, int root) {
  const int columns = costs.columns();
  distance_.assign(at(columns), kNever);
  from_.assign(at(columns), -1);
  done_.assign(at(columns), 0);
  double length = 0.0;  // of the shortest path to `row`
  double alone = kNever;
  int loner = -1;
  int row = root;
  int last = -1;
  while (true) {
    if (length - row_price_[at(row)] < alone) {
      alone = length - row_price_[at(row)];
      loner = row;
    }
    last = -1;
    for (int column = 0; column < columns; ++column) {
      if (done_[at(column)]) continue;
      const double there =
          length + costs.at(row, column) - row_price_[at(row)] - column_price_[at(column)];
      if (std::isfinite(there) && there < distance_[at(column)]) {
        distance_[at(column)] = there;
        from_[at(column)] = row;
      }
      if (from_[at(column)] >= 0 && (last < 0 || distance_[at(column)] < distance_[at(last)])) {
        last = column;
      }
    }
    if (last < 0 || alone <= distance_[at(last)]) {
      last = -1;
      length = alone;
      break;
    }
    length = distance_[at(last)];
    if (row_of_[at(last)] < 0) break;
    done_[at(last)] = 1;
    row = row_of_[at(last)];
  }
  row_price_[at(root)] += length;
  for (int column = 0; column < columns; ++column) {
    if (!done_[at(column)]) continue;
    row_price_[at(row_of_[at(column)])] += length - distance_[at(column)];
    column_price_[at(column)] -= length - distance_[at(column)];
  }
  follow_back(loner, last);
}

void PairAssignment::follow_back(int row, int column) {
  if (column < 0) {
    column = column_of_[at(row)];
    column_of_[at(row)] = -1;
  }
  while (column >= 0) {
    const int taker = from_[at(column)];
    const int next = column_of_[at(taker)];
    row_of_[at(column)] = taker;
    column_of_[at(taker)] = column;
    column = next;
  }
}

}  // namespace headland
