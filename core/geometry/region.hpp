// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/geometry/polygon.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

/// An area indexed for millions of "does the vehicle fit here" questions: its edges lie in a grid.
/// Polygons that overlap or share a border count as one area.
class Region {
 public:
  Region() = default;
  explicit Region(const std::vector<Polygon>& polygons);

  const std::vector<Polygon>& polygons() const { return polygons_; }
  double area() const;
  bool contains(const Point2& p) const;
  /// True if the whole outline of a vehicle at `T_map_base`, widened by `margin` [m] on all sides,
  /// lies inside (it may touch the border). About 0.1 us; does not allocate; thread-safe.
  bool contains(const Pose2& T_map_base, const Footprint& footprint, double margin = 0.0) const;

 private:
  struct Edge {
    Point2 a;
    Point2 b;
  };
  void size_grid();
  void enter_edges();
  void mark_empty_cells();
  int column_of(double x) const {
    return std::min(static_cast<int>((x - corner_.x()) / cell_), columns_ - 1);
  }
  int row_of(double y) const {
    return std::min(static_cast<int>((y - corner_.y()) / cell_), rows_ - 1);
  }
  std::size_t cell_index(int column, int row) const {
    return static_cast<std::size_t>(row * columns_ + column);
  }

  std::vector<Polygon> polygons_;
  std::vector<Edge> edges_;
  Point2 corner_{0.0, 0.0};  // of the grid, lower left
  double cell_ = 1.0;        // [m]
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::int32_t>
      cell_begin_;  // edges of cell c: cell_edges_[cell_begin_[c] .. cell_begin_[c+1])
  std::vector<std::int32_t> cell_edges_;
  std::vector<std::int8_t> cell_inside_;  // of cells without edges
};

}  // namespace headland
