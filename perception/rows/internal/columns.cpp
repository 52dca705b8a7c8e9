// SPDX-License-Identifier: Apache-2.0
#include "perception/rows/internal/columns.hpp"

#include <algorithm>
#include <cmath>

namespace headland::internal {

ColumnGrid::ColumnGrid(const ColumnConfig& config)
    : config_(config),
      length_(static_cast<int>(std::ceil((config.behind_m + config.ahead_m) / config.cell_m))),
      width_(static_cast<int>(std::ceil(2.0 * config.aside_m / config.cell_m))) {
  cells_.resize(static_cast<std::size_t>(length_) * static_cast<std::size_t>(width_));
}

std::span<const Column> ColumnGrid::fill(std::span<const LidarPoint> points_base,
                                         const FittedPlane& ground) {
  for (const int cell : filled_) cells_[static_cast<std::size_t>(cell)].count = 0;
  filled_.clear();
  const Eigen::Vector3f normal = ground.normal.cast<float>();
  const auto constant = static_cast<float>(ground.constant_m);
  const auto low = static_cast<float>(config_.low_m);
  const auto high = static_cast<float>(config_.high_m);
  const auto behind = static_cast<float>(config_.behind_m);
  const auto aside = static_cast<float>(config_.aside_m);
  const auto per_cell = static_cast<float>(1.0 / config_.cell_m);
  for (const LidarPoint& point : points_base) {
    const float height = normal.dot(point.position) + constant;
    if (!(height >= low && height <= high)) continue;  // NaN too
    const Eigen::Vector2f p = point.position.head<2>() - height * normal.head<2>();
    const float row = (p.x() + behind) * per_cell;
    const float column = (p.y() + aside) * per_cell;
    if (!(row >= 0.0f && row < static_cast<float>(length_))) continue;
    if (!(column >= 0.0f && column < static_cast<float>(width_))) continue;
    const int index = static_cast<int>(row) * width_ + static_cast<int>(column);
    Cell& cell = cells_[static_cast<std::size_t>(index)];
    if (cell.count == 0) {
      filled_.push_back(index);
      cell = {0.0f, 0.0f, height, height, 0};
    }
    cell.x += p.x();
    cell.y += p.y();
    cell.low = std::min(cell.low, height);
    cell.high = std::max(cell.high, height);
    ++cell.count;
  }
  columns_.clear();
  const auto flat = static_cast<float>(config_.flat_weight);
  const auto per_tall = static_cast<float>(1.0 / config_.tall_m);
  for (const int index : filled_) {
    const Cell& cell = cells_[static_cast<std::size_t>(index)];
    const auto count = static_cast<float>(cell.count);
    const float tallness = std::min(1.0f, (cell.high - cell.low) * per_tall);
    columns_.push_back({cell.x / count, cell.y / count, flat + (1.0f - flat) * tallness});
  }
  return columns_;
}

}  // namespace headland::internal
