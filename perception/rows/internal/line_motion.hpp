// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "core/geometry/pose2.hpp"
#include "perception/rows/row_line.hpp"

namespace headland::internal {

// How far a motion of the robot goes along a row of this heading, and to its left [m].
inline Point2 motion_in_row(double heading_rad, const Pose2& moved) {
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  return {c * moved.x + s * moved.y, c * moved.y - s * moved.x};
}

// The same lines seen from base after it has `moved`; the covariance is left as it is.
inline void move_lane(RowEstimate& lane, const Pose2& moved) {
  const Point2 step = motion_in_row(lane.heading_rad, moved);
  lane.offset_m -= step.y();
  lane.left_m -= step.y();
  lane.right_m -= step.y();
  lane.heading_rad = wrap_angle(lane.heading_rad - moved.yaw);
  lane.row_end.distance_m -= step.x();
}

}  // namespace headland::internal
