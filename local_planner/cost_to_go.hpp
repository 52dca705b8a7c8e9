// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/pose2.hpp"

namespace headland {

/// Length [m] of the shortest forward way of curvature at most 1 / radius from `from` until its
/// position is within `accuracy` [m] of `place`, arriving in any heading: a turn and a straight, or
/// two turns where the place lies inside the near turning circle. 0 if it is there already. Seed
/// 003 found that evasion leaves car-like robots where the goal "is no longer kinematically
/// feasible without a more circuitous route": this is that route's length. Two-turn ways are at
/// most a fifth longer than the shortest. About 0.1 us; does not allocate.
/// @param radius Minimum turning radius [m], >= 0 (not checked); 0: turns on the spot.
double forward_distance(const Pose2& from, const Point2& place, double accuracy, double radius);
/// The same with the place in the vehicle's frame (x ahead, y to the left) [m].
double forward_distance(const Point2& place_base, double accuracy, double radius);

}  // namespace headland
