// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/assignment.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace headland::tour {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

double Assignment::bound() const {
  return std::accumulate(row_price.begin(), row_price.end(), 0.0) +
         std::accumulate(column_price.begin(), column_price.end(), 0.0);
}

bool augment(const CostMatrix& costs, Assignment& a, int row) {
  const int n = costs.size;
  std::vector<double> distance(at(n), kInfinity);
  std::vector<int> from(at(n), row);  // the row by which a column is reached
  std::vector<int> open(at(n));
  std::iota(open.begin(), open.end(), 0);
  std::vector<int> settled;
  double reached = 0.0;
  int sink = -1;
  for (int current = row; sink < 0;) {
    const double* cost = costs.row(current);
    const double base = reached - a.row_price[at(current)];
    std::size_t nearest = open.size();
    double least = kInfinity;
    for (std::size_t k = 0; k < open.size(); ++k) {
      const int column = open[k];
      const double through = base + cost[column] - a.column_price[at(column)];
      if (through < distance[at(column)]) {
        distance[at(column)] = through;
        from[at(column)] = current;
      }
      const double d = distance[at(column)];
      if (d < least || (d == least && nearest < open.size() && a.row_of[at(column)] < 0 &&
                        a.row_of[at(open[nearest])] >= 0)) {
        least = d;
        nearest = k;
      }
    }
    if (!(least < kInfinity)) return false;
    const int column = open[nearest];
    open[nearest] = open.back();
    open.pop_back();
    reached = least;
    settled.push_back(column);
    if (a.row_of[at(column)] < 0) {
      sink = column;
    } else {
      current = a.row_of[at(column)];
    }
  }
  // Prices keep every reduced cost at 0 or more, and the path's at 0.
  a.row_price[at(row)] += reached;
  for (const int column : settled) {
    const double slack = reached - distance[at(column)];
    a.column_price[at(column)] -= slack;
    if (a.row_of[at(column)] >= 0) a.row_price[at(a.row_of[at(column)])] += slack;
  }
  for (int column = sink;;) {
    const int r = from[at(column)];
    std::swap(a.column_of[at(r)], column);
    a.row_of[at(a.column_of[at(r)])] = r;
    if (r == row) return true;
  }
}

bool assign(const CostMatrix& costs, Assignment& a) {
  const int n = costs.size;
  a.column_of.assign(at(n), -1);
  a.row_of.assign(at(n), -1);
  a.row_price.assign(at(n), 0.0);
  a.column_price.assign(at(n), kInfinity);
  for (int row = 0; row < n; ++row) {
    for (int column = 0; column < n; ++column) {
      a.column_price[at(column)] = std::min(a.column_price[at(column)], costs.at(row, column));
    }
  }
  for (int row = 0; row < n; ++row) {
    if (!(a.column_price[at(row)] < kInfinity)) return false;
    if (!augment(costs, a, row)) return false;
  }
  return true;
}

Cycles cycles_of(const Successors& next) {
  Cycles cycles;
  std::vector<bool> seen(next.size(), false);
  for (int first = 0; first < std::ssize(next); ++first) {
    if (seen[at(first)]) continue;
    cycles.emplace_back();
    for (int node = first; !seen[at(node)]; node = next[at(node)]) {
      seen[at(node)] = true;
      cycles.back().push_back(node);
    }
  }
  return cycles;
}

}  // namespace headland::tour
