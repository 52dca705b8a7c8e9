// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/world/lidar.hpp"

namespace headland {

/// Which returns of a lidar are worth looking at, in `base` [m].
struct CropConfig {
  double near_m = 0.5;
  double far_m = 40.0;
  double low_m = -3.0;
  double high_m = 6.0;

  template <class V>
  void visit(V& v) {
    v("near_m", near_m, config::kNonNegative, "Nearer to the sensor it is the vehicle itself [m]");
    v("far_m", far_m, config::kPositive, "Farther from the sensor it is not looked at [m]");
    v("low_m", low_m, config::Range{-100.0, 0.0}, "Lowest, against base [m]");
    v("high_m", high_m, config::Range{0.0, 100.0}, "Highest, against base [m]");
  }
};

/// The finite points of a scan that lie within `crop`, taken to another frame (T_base_sensor).
/// Order, intensity, ring and time of points are kept. O(n); reuses the memory of `out`.
void crop_to_base(std::span<const LidarPoint> points, const Eigen::Isometry3d& T_base_sensor,
                  const CropConfig& crop, std::vector<LidarPoint>& out);

}  // namespace headland
