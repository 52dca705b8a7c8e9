// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/world/lidar.hpp"
#include "perception/rows/internal/ground_fit.hpp"

namespace headland::internal {

// What stands on one cell of the ground: the mean place of its points in the height band, projected
// onto the ground ((000) Eq. 1), and how much a row it looks: tall ones weigh more.
struct Column {
  float x = 0.0f;       // [m, base]
  float y = 0.0f;       // [m, base]
  float weight = 0.0f;  // up to 1
};

struct ColumnConfig {
  double cell_m = 0.1;
  double behind_m = 12.0;
  double ahead_m = 16.0;
  double aside_m = 8.0;
  double low_m = 0.3;
  double high_m = 2.0;
  double tall_m = 0.6;       // from this height span on a column weighs 1
  double flat_weight = 0.3;  // of one without height
};

// Bins a scan into columns. Keeps its memory between scans; O(points).
class ColumnGrid {
 public:
  explicit ColumnGrid(const ColumnConfig& config);

  std::span<const Column> fill(std::span<const LidarPoint> points_base, const FittedPlane& ground);

 private:
  struct Cell {
    float x = 0.0f;
    float y = 0.0f;
    float low = 0.0f;
    float high = 0.0f;
    int count = 0;
  };

  ColumnConfig config_;
  int length_;
  int width_;
  std::vector<Cell> cells_;
  std::vector<int> filled_;
  std::vector<Column> columns_;
};

}  // namespace headland::internal
