// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/region.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kTouch = 1e-9;  // [m] an outline may touch the border, up to rounding
constexpr double kPad = 1e-6;    // [m] edges are entered into neighbouring cells this near
constexpr double kCellsPerEdge = 16.0;
constexpr double kSmallestCell = 0.25;  // [m]
constexpr double kMostCells = 1 << 20;

// x where the edge a-b meets the horizontal line at y; the caller knows that it does. The same
// number from whichever cell asks, so that each crossing is counted in exactly one cell.
double crossing_x(const Point2& a, const Point2& b, double y) {
  return a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
}

bool crosses_line(const Point2& a, const Point2& b, double y) { return (a.y() > y) != (b.y() > y); }

// An upright box around the centre of a frame: the vehicle's outline in its own frame.
struct Box {
  Point2 center;  // in map
  double cos_yaw = 1.0;
  double sin_yaw = 0.0;
  double half_length = 0.0;
  double half_width = 0.0;
};

// Separating axes of the box and the segment a-b: the box's two, and the segment's normal.
bool meets(const Box& box, const Point2& a, const Point2& b) {
  const Point2 middle = 0.5 * (a + b) - box.center;
  const Point2 half = 0.5 * (b - a);
  const double mx = box.cos_yaw * middle.x() + box.sin_yaw * middle.y();
  const double my = -box.sin_yaw * middle.x() + box.cos_yaw * middle.y();
  const double dx = box.cos_yaw * half.x() + box.sin_yaw * half.y();
  const double dy = -box.sin_yaw * half.x() + box.cos_yaw * half.y();
  const double ax = std::abs(dx);
  const double ay = std::abs(dy);
  if (std::abs(mx) > box.half_length + ax) return false;
  if (std::abs(my) > box.half_width + ay) return false;
  return std::abs(mx * dy - my * dx) <= box.half_length * ay + box.half_width * ax;
}

}  // namespace

Region::Region(const std::vector<Polygon>& polygons) : polygons_(unite(polygons)) {
  const auto add_ring = [this](const Polyline& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      edges_.push_back({ring[i], ring[(i + 1) % ring.size()]});
    }
  };
  for (const Polygon& polygon : polygons_) {
    add_ring(polygon.outer);
    std::for_each(polygon.holes.begin(), polygon.holes.end(), add_ring);
  }
  if (edges_.empty()) return;
  size_grid();
  enter_edges();
  mark_empty_cells();
}

void Region::size_grid() {
  Point2 low = edges_.front().a;
  Point2 high = low;
  for (const Edge& e : edges_) {
    low = low.cwiseMin(e.a);
    high = high.cwiseMax(e.a);
  }
  const Point2 extent = high - low;
  const double target = std::min(kCellsPerEdge * static_cast<double>(edges_.size()), kMostCells);
  cell_ = std::max(
      {std::sqrt(extent.x() * extent.y() / target), extent.maxCoeff() / target, kSmallestCell});
  // A rim of cells outside on all sides: padding never leaves the grid, and rays end outside.
  corner_ = low - Point2(cell_, cell_);
  columns_ = static_cast<int>(std::ceil(extent.x() / cell_)) + 2;
  rows_ = static_cast<int>(std::ceil(extent.y() / cell_)) + 2;
}

void Region::enter_edges() {
  std::vector<std::vector<std::int32_t>> cells(static_cast<std::size_t>(columns_ * rows_));
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const auto& [a, b] = edges_[i];
    const int first_row = row_of(std::min(a.y(), b.y()) - kPad);
    const int last_row = row_of(std::max(a.y(), b.y()) + kPad);
    for (int row = first_row; row <= last_row; ++row) {
      // The stretch of the edge between the row's lower and upper side.
      const double y0 = corner_.y() + row * cell_ - kPad;
      const double y1 = y0 + cell_ + 2.0 * kPad;
      const double dy = b.y() - a.y();
      double t0 = 0.0;
      double t1 = 1.0;
      if (std::abs(dy) > kPad) {
        const double u = (y0 - a.y()) / dy;
        const double v = (y1 - a.y()) / dy;
        t0 = std::clamp(std::min(u, v), 0.0, 1.0);
        t1 = std::clamp(std::max(u, v), 0.0, 1.0);
      }
      const double xa = a.x() + t0 * (b.x() - a.x());
      const double xb = a.x() + t1 * (b.x() - a.x());
      const int last_column = column_of(std::max(xa, xb) + kPad);
      for (int column = column_of(std::min(xa, xb) - kPad); column <= last_column; ++column) {
        cells[cell_index(column, row)].push_back(static_cast<std::int32_t>(i));
      }
    }
  }
  cell_begin_.reserve(cells.size() + 1);
  for (const auto& cell : cells) {
    cell_begin_.push_back(static_cast<std::int32_t>(cell_edges_.size()));
    cell_edges_.insert(cell_edges_.end(), cell.begin(), cell.end());
  }
  cell_begin_.push_back(static_cast<std::int32_t>(cell_edges_.size()));
}

// Row by row from the right: the cell right of the grid is outside, and the centre line's crossings
// change sides. An empty cell is on one side altogether.
void Region::mark_empty_cells() {
  cell_inside_.assign(static_cast<std::size_t>(columns_ * rows_), 0);
  std::vector<double> crossings;
  for (int row = 0; row < rows_; ++row) {
    const double y = corner_.y() + (row + 0.5) * cell_;
    crossings.clear();
    for (const Edge& e : edges_) {
      if (crosses_line(e.a, e.b, y)) crossings.push_back(crossing_x(e.a, e.b, y));
    }
    std::sort(crossings.begin(), crossings.end());
    for (int column = 0; column < columns_; ++column) {
      const double x = corner_.x() + (column + 0.5) * cell_;
      const auto right = crossings.end() - std::upper_bound(crossings.begin(), crossings.end(), x);
      cell_inside_[cell_index(column, row)] = static_cast<std::int8_t>(right % 2);
    }
  }
}

double Region::area() const {
  double sum = 0.0;
  for (const Polygon& polygon : polygons_) sum += headland::area(polygon);
  return sum;
}

bool Region::contains(const Point2& p) const {
  if (edges_.empty()) return false;
  const Point2 in_grid = p - corner_;
  if (!(in_grid.x() >= 0.0 && in_grid.y() >= 0.0 && in_grid.x() < columns_ * cell_ &&
        in_grid.y() < rows_ * cell_)) {
    return false;  // also for NaN
  }
  // A ray to the right, as far as the first cell without edges.
  const int row = row_of(p.y());
  bool odd = false;
  for (int column = column_of(p.x()); column < columns_; ++column) {
    const std::size_t cell = cell_index(column, row);
    const std::int32_t begin = cell_begin_[cell];
    const std::int32_t end = cell_begin_[cell + 1];
    if (begin == end) return odd != (cell_inside_[cell] != 0);
    for (std::int32_t k = begin; k < end; ++k) {
      const Edge& e = edges_[static_cast<std::size_t>(cell_edges_[static_cast<std::size_t>(k)])];
      if (!crosses_line(e.a, e.b, p.y())) continue;
      const double x = crossing_x(e.a, e.b, p.y());
      odd ^= x > p.x() && column_of(x) == column;
    }
  }
  return odd;
}

bool Region::contains(const Pose2& T_map_base, const Footprint& footprint, double margin) const {
  if (edges_.empty()) return false;
  Box box;
  box.cos_yaw = std::cos(T_map_base.yaw);
  box.sin_yaw = std::sin(T_map_base.yaw);
  const double ahead = 0.5 * (footprint.front_m - footprint.rear_m);
  box.center = {T_map_base.x + ahead * box.cos_yaw, T_map_base.y + ahead * box.sin_yaw};
  box.half_length = 0.5 * (footprint.front_m + footprint.rear_m) + margin - kTouch;
  box.half_width = 0.5 * footprint.width_m + margin - kTouch;
  const double reach_x =
      std::abs(box.cos_yaw) * box.half_length + std::abs(box.sin_yaw) * box.half_width;
  const double reach_y =
      std::abs(box.sin_yaw) * box.half_length + std::abs(box.cos_yaw) * box.half_width;
  const Point2 center = box.center - corner_;
  if (!(center.x() - reach_x >= 0.0 && center.y() - reach_y >= 0.0 &&
        center.x() + reach_x < columns_ * cell_ && center.y() + reach_y < rows_ * cell_)) {
    return false;  // the rim around the area is outside, so this is too; also for NaN
  }
  const int first_column = column_of(box.center.x() - reach_x);
  const int last_column = column_of(box.center.x() + reach_x);
  const int last_row = row_of(box.center.y() + reach_y);
  for (int row = row_of(box.center.y() - reach_y); row <= last_row; ++row) {
    const std::int32_t begin = cell_begin_[cell_index(first_column, row)];
    const std::int32_t end = cell_begin_[cell_index(last_column, row) + 1];
    for (std::int32_t k = begin; k < end; ++k) {
      const Edge& e = edges_[static_cast<std::size_t>(cell_edges_[static_cast<std::size_t>(k)])];
      if (meets(box, e.a, e.b)) return false;
    }
  }
  // No border runs through the outline, so that one point speaks for all of it.
  return contains(box.center);
}

}  // namespace headland
