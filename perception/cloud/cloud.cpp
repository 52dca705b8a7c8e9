// SPDX-License-Identifier: Apache-2.0
#include "perception/cloud/cloud.hpp"

namespace headland {

void crop_to_base(std::span<const LidarPoint> points, const Eigen::Isometry3d& T_base_sensor,
                  const CropConfig& crop, std::vector<LidarPoint>& out) {
  out.clear();
  out.reserve(points.size());
  const Eigen::Isometry3f T = T_base_sensor.cast<float>();
  const auto near2 = static_cast<float>(crop.near_m * crop.near_m);
  const auto far2 = static_cast<float>(crop.far_m * crop.far_m);
  const auto low = static_cast<float>(crop.low_m);
  const auto high = static_cast<float>(crop.high_m);
  for (const LidarPoint& point : points) {
    const float r2 = point.position.squaredNorm();
    if (!(r2 >= near2 && r2 <= far2)) continue;  // NaN too
    LidarPoint moved = point;
    moved.position = T * point.position;
    if (!(moved.position.z() >= low && moved.position.z() <= high)) continue;
    out.push_back(moved);
  }
}

}  // namespace headland
