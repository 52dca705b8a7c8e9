// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/polygon.hpp"

namespace headland {

/// How far it is to the nearest static obstacle, looked up in constant time: distances on a grid.
/// Without obstacles (default) everything is far away. What lies off the grid counts as far away
/// too, but for the distance to the grid's own obstacles.
class ClearanceMap {
 public:
  /// No obstacles.
  ClearanceMap() = default;
  /// Cells of `cell` [m] from `corner` (lower left) on, row by row; `blocked[row * columns +
  /// column]`. Distances are exact between cell centres (Felzenszwalb and Huttenlocher 2012).
  /// O(cells).
  ClearanceMap(const Point2& corner, double cell, int columns, int rows,
               const std::vector<std::uint8_t>& blocked);
  /// Everything outside `free` is an obstacle; the grid reaches `margin` [m] beyond it.
  static ClearanceMap around(const std::vector<Polygon>& free, double cell = 0.2,
                             double margin = 2.0);
  /// The polygons are obstacles.
  static ClearanceMap of(const std::vector<Polygon>& obstacles, double cell = 0.2,
                         double reach = 10.0);

  bool empty() const { return distance_.empty(); }
  /// Lower bound of the distance [m] from a point to the nearest obstacle: short of the true one by
  /// at most 1.5 cells; 0 in obstacles. At most kFar. About 2 ns, thread-safe.
  double clearance(const Point2& p) const {
    if (distance_.empty()) return kFar;
    const double column = (p.x() - corner_.x()) * per_metre_;
    const double row = (p.y() - corner_.y()) * per_metre_;
    if (!(column >= 0.0 && row >= 0.0 && column < columns_ && row < rows_)) return off_grid(p);
    return distance_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(column)];
  }
  /// Whether a disc of `radius` [m] moves from a to b without touching an obstacle, by strides of
  /// its clearance.
  bool disc_passes(const Point2& a, const Point2& b, double radius) const;
  /// Direction away from the nearest obstacle (unit vector; zero where there is none near).
  Point2 away(const Point2& p) const;

  static constexpr double kFar = 1e3;  ///< [m]

 private:
  double off_grid(const Point2& p) const;

  Point2 corner_{0.0, 0.0};
  double cell_ = 1.0;
  double per_metre_ = 1.0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> distance_;  // [m]
};

}  // namespace headland
