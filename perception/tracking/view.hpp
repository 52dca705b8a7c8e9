// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/geometry/pose2.hpp"

namespace headland {

/// Directions in which a sensor sees nothing beyond some distance.
struct HiddenArc {
  double begin_rad = 0.0;  ///< azimuth in `map`, counter-clockwise from east
  double width_rad = 0.0;  ///< counter-clockwise from there
  double beyond_m = 0.0;   ///< from the sensor; 0: a blind sector
};

/// What a sensor could see in one scan, whether or not anybody was there.
struct SensorView {
  Point2 sensor{0.0, 0.0};  ///< in `map` [m]
  double near_m = 0.5;
  double far_m = 40.0;
  std::vector<HiddenArc> hidden;  ///< blind sectors, and shadows of what stands there

  /// The part of a disc's width that lies in view, in ninths. 0 out of range or for no numbers.
  /// O(arcs).
  double visible_share(const Point2& centre, double radius) const {
    return visible_share(centre, radius, hidden);
  }
  /// Likewise, with other shadows.
  double visible_share(const Point2& centre, double radius,
                       std::span<const HiddenArc> shadows) const;
};

/// The arc behind a body of that width, from `behind` [m] behind its centre on.
HiddenArc shadow_of(const Point2& sensor, const Point2& centre, double width, double behind);

/// The shadows of all points that stand out of the ground, among `bins` equal arcs of azimuth: what
/// lies more than `behind` [m] farther than the nearest point of its arc is hidden. Joins arcs that
/// follow each other and begin about as far. Points that are not finite are ignored.
void add_shadows(std::span<const Point2> points, double behind, int bins, SensorView& view);

}  // namespace headland
