// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/report.hpp"
#include "core/world/ground.hpp"

namespace headland {

/// The heights of the ground under a box of the map, at most kMostTerrainPoints a side and no finer
/// than the terrain's own grid. NaN where there are none.
ReportTerrain terrain_raster(const Ground& ground, const MapBox& extent);

inline constexpr int kMostTerrainPoints = 400;

}  // namespace headland
