// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/geometry/region.hpp"

namespace headland::roadmap {

/// Distances to a goal around obstacles, for a disc: Dijkstra on a grid of eight neighbours, from
/// the goal, run only as far as it is asked. A cell is blocked only if the disc fits nowhere in it,
/// so that no way is missed.
class GridDistance {
 public:
  /// @param radius Of the disc [m]. @param cell [m].
  GridDistance(const Region& area, double radius, double cell, const Point2& goal);

  /// About how far a disc at `p` is from the goal [m], to a cell and to the grid's directions;
  /// infinite where no way leads there.
  double at(const Point2& p);

 private:
  struct Cell {
    double distance;
    std::int8_t settled = 0;
    std::int8_t free = -1;  // -1: not yet known
  };
  int column_of(const Point2& p) const;
  int row_of(const Point2& p) const;
  Cell& cell(int column, int row) {
    return cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(column)];
  }
  bool is_free(int column, int row);
  void settle_next();
  void offer(int column, int row, double distance);

  const Region& area_;
  double radius_;
  double size_;
  Point2 corner_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<Cell> cells_;
  std::vector<std::pair<double, std::int64_t>> queue_;  // a heap, nearest on top
};

}  // namespace headland::roadmap
