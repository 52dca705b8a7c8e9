// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/world/farm.hpp"
#include "global_planner/coverage/internal/free_space.hpp"

namespace headland::coverage {

/// Poses along the ways that a vehicle would take outside rows, each to be driven in both senses:
/// around the blocks of rows (at the turning radius where there is room, else close to the rows),
/// along roads, through gates, and over open ground on a grid. Only poses where the outline fits
/// both ways. Deterministic.
/// @param clearance Least distance of the vehicle's centre line to an edge [m].
/// @param radius    Turning radius [m].
std::vector<Pose2> lane_poses(const Farm& farm, const std::vector<Polygon>& drivable,
                              const std::vector<RowBody>& rows, const FreeSpace& space,
                              double clearance, double radius);

}  // namespace headland::coverage
