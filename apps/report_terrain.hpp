// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "apps/report.hpp"
#include "core/world/ground.hpp"

namespace headland {

/// The heights of the ground under a box of the map, at most kMostTerrainPoints a side and no finer
/// than the terrain's own grid. NaN where there are none.
ReportTerrain terrain_raster(const Ground& ground, const MapBox& extent);

inline constexpr int kMostTerrainPoints = 400;

/// Heights as unsigned numbers of 16 bits, little end first, in base64: from 0 for the lowest to
/// 65534 for the highest; 65535 where there is none.
struct PackedHeights {
  double low_m = 0.0;
  double high_m = 0.0;
  std::string base64;
};
PackedHeights pack(const std::vector<double>& heights_m);

/// Base64 as RFC 4648, section 4.
std::string base64(const std::vector<unsigned char>& bytes);

}  // namespace headland
