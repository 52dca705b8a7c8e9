// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/region.hpp"

namespace headland::internal {

/// Draws places with directions for a roadmap: around the border's corners, where ways bend;
/// anywhere in the box around the area; and anywhere along the nearest border, as roads and
/// headlands are driven.
class PoseSampler {
 public:
  /// Goes on after `draws` earlier ones. Requires an area.
  PoseSampler(const Region& region, double turning_radius, std::uint64_t seed, std::int64_t draws);

  /// One draw; none where it lies outside.
  std::optional<Pose2> draw();
  /// The last draw became a node.
  void accept() { misses_ = 0; }

  const Point2& low() const { return low_; }    ///< of the box around the area [m]
  const Point2& high() const { return high_; }  ///< [m]
  std::int64_t draws() const { return draws_; }
  int misses() const { return misses_; }  ///< draws since the last node

 private:
  double border_direction(const Point2& p) const;

  const Region& region_;
  double reach_;  // around corners [m]
  RandomStream random_;
  std::int64_t draws_ = 0;
  int misses_ = 0;
  double kind_ = 0.0;  // of place, in [0, 1)
  std::vector<Point2> corners_;
  Point2 low_;
  Point2 high_;
};

}  // namespace headland::internal
