// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace headland::tour {

/// Every node's successor.
using Successors = std::vector<int>;

/// A square matrix of directed costs; infinity where there is no way.
struct CostMatrix {
  int size = 0;
  std::vector<double> cost;  ///< from * size + to

  explicit CostMatrix(int n, double value = 0.0)
      : size(n), cost(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), value) {}
  double& at(int from, int to) {
    return cost[static_cast<std::size_t>(from) * static_cast<std::size_t>(size) +
                static_cast<std::size_t>(to)];
  }
  double at(int from, int to) const { return const_cast<CostMatrix&>(*this).at(from, to); }
  const double* row(int from) const {
    return &cost[static_cast<std::size_t>(from) * static_cast<std::size_t>(size)];
  }
};

/// Each row's column and each column's row (-1: none), with prices: cost >= row + column price,
/// equal where assigned (linear programming duality).
struct Assignment {
  std::vector<int> column_of;
  std::vector<int> row_of;
  std::vector<double> row_price;
  std::vector<double> column_price;

  double bound() const;  ///< the prices' sum: no assignment costs less
};

/// Gives a free row a column by the cheapest augmenting path (Dijkstra over reduced costs; Tomizawa
/// 1971, Jonker and Volgenant 1987); false if there is none. O(n^2).
bool augment(const CostMatrix& costs, Assignment& assignment, int row);

/// The cheapest assignment of all rows; false if there is none. O(n^3).
bool assign(const CostMatrix& costs, Assignment& assignment);

using Cycles = std::vector<std::vector<int>>;

/// The cycles into which successors fall, each from its lowest node on.
Cycles cycles_of(const Successors& next);

}  // namespace headland::tour
