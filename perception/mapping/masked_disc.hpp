// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/geometry/polygon.hpp"
#include "core/world/lidar.hpp"

namespace headland {

/// A place whose returns are somebody's whom a tracker follows: they are no part of a map.
struct MaskedDisc {
  Point2 center{0.0, 0.0};  ///< [m], in the map's frame
  double radius = 0.0;      ///< [m]
};

/// Whether a point lies in one of the discs, at any height.
inline bool is_masked(const Eigen::Vector3f& point, std::span<const MaskedDisc> discs) {
  for (const MaskedDisc& disc : discs) {
    const Point2 off = point.head<2>().cast<double>() - disc.center;
    if (off.squaredNorm() <= disc.radius * disc.radius) return true;
  }
  return false;
}

}  // namespace headland
