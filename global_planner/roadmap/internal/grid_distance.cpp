// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/internal/grid_distance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace headland::roadmap {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kParts = 3;  // a cell is probed at the centres of its parts, so many a side

}  // namespace

GridDistance::GridDistance(const Region& area, double radius, double cell_size, const Point2& goal)
    : area_(area), radius_(radius), size_(cell_size) {
  Point2 low = goal;
  Point2 high = goal;
  for (const Polygon& polygon : area.polygons()) {
    for (const Point2& p : polygon.outer) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  corner_ = low;
  columns_ = static_cast<int>((high.x() - low.x()) / size_) + 1;
  rows_ = static_cast<int>((high.y() - low.y()) / size_) + 1;
  cells_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
                Cell{kInfinite});
  offer(column_of(goal), row_of(goal), 0.0);
}

int GridDistance::column_of(const Point2& p) const {
  return static_cast<int>(std::floor((p.x() - corner_.x()) / size_));
}

int GridDistance::row_of(const Point2& p) const {
  return static_cast<int>(std::floor((p.y() - corner_.y()) / size_));
}

// Wherever in the cell the disc may be, one of the probes lies so near that the disc, smaller by
// that distance, fits there too; and so does the square in that smaller disc.
bool GridDistance::is_free(int column, int row) {
  Cell& here = cell(column, row);
  if (here.free >= 0) return here.free != 0;
  const double part = size_ / kParts;
  const double smaller = std::max(radius_ - 0.5 * std::numbers::sqrt2 * part, 0.0);
  const double half = smaller / std::numbers::sqrt2;
  const Footprint square{half, half, 2.0 * half};
  here.free = 0;
  for (int i = 0; i < kParts * kParts && here.free == 0; ++i) {
    const Pose2 probe{corner_.x() + column * size_ + (i % kParts + 0.5) * part,
                      corner_.y() + row * size_ + (i / kParts + 0.5) * part, 0.0};
    here.free = area_.contains(probe, square) ? 1 : 0;
  }
  return here.free != 0;
}

void GridDistance::offer(int column, int row, double distance) {
  Cell& here = cell(column, row);
  if (distance >= here.distance) return;
  here.distance = distance;
  queue_.emplace_back(distance, static_cast<std::int64_t>(row) * columns_ + column);
  std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
}

void GridDistance::settle_next() {
  std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
  const auto [distance, index] = queue_.back();
  queue_.pop_back();
  const int column = static_cast<int>(index % columns_);
  const int row = static_cast<int>(index / columns_);
  Cell& here = cell(column, row);
  if (here.settled != 0) return;
  here.settled = 1;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows_ - 1); ++r) {
    for (int c = std::max(column - 1, 0); c <= std::min(column + 1, columns_ - 1); ++c) {
      if (cell(c, r).settled != 0 || !is_free(c, r)) continue;
      offer(c, r, distance + size_ * (r != row && c != column ? std::numbers::sqrt2 : 1.0));
    }
  }
}

double GridDistance::at(const Point2& p) {
  const int column = column_of(p);
  const int row = row_of(p);
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return kInfinite;
  const Cell& here = cell(column, row);
  while (here.settled == 0 && !queue_.empty()) settle_next();
  return here.settled != 0 ? std::max(here.distance - size_, 0.0) : kInfinite;
}

}  // namespace headland::roadmap
