// SPDX-License-Identifier: Apache-2.0
#include "perception/rows/internal/euclidean_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

namespace headland::internal {
namespace {

using Cell = std::pair<std::int64_t, std::int64_t>;

int root_of(std::vector<int>& parent, int i) {
  const auto at = [&](int k) -> int& { return parent[static_cast<std::size_t>(k)]; };
  while (at(i) != i) {
    at(i) = at(at(i));
    i = at(i);
  }
  return i;
}

}  // namespace

std::vector<int> euclidean_clusters(std::span<const Eigen::Vector2d> points, double tolerance) {
  // Cells as wide as the tolerance: neighbours lie in the same cell or one beside it.
  std::map<Cell, std::vector<int>> cells;
  const auto cell_of = [&](const Eigen::Vector2d& p) {
    return Cell{static_cast<std::int64_t>(std::floor(p.x() / tolerance)),
                static_cast<std::int64_t>(std::floor(p.y() / tolerance))};
  };
  std::vector<int> parent(points.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const Eigen::Vector2d& p = points[static_cast<std::size_t>(i)];
    const Cell cell = cell_of(p);
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const auto near = cells.find({cell.first + dx, cell.second + dy});
        if (near == cells.end()) continue;
        for (const int j : near->second) {
          if ((points[static_cast<std::size_t>(j)] - p).norm() > tolerance) continue;
          const int a = root_of(parent, i);
          const int b = root_of(parent, j);
          parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
        }
      }
    }
    cells[cell].push_back(i);
  }
  std::vector<int> label(points.size(), -1);
  int count = 0;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const auto root = static_cast<std::size_t>(root_of(parent, i));
    if (label[root] < 0) label[root] = count++;
    label[static_cast<std::size_t>(i)] = label[root];
  }
  return label;
}

}  // namespace headland::internal
