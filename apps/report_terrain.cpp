// SPDX-License-Identifier: Apache-2.0
#include "apps/report_terrain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace headland {

ReportTerrain terrain_raster(const Ground& ground, const MapBox& extent) {
  ReportTerrain raster;
  if (extent.isEmpty()) return raster;
  const Point2 size = extent.sizes();
  const double finest = ground.terrain() != nullptr ? ground.terrain()->cell() : 1.0;
  raster.cell_m = std::max(size.maxCoeff() / (kMostTerrainPoints - 1), finest);
  raster.south_west = extent.min();
  raster.columns = static_cast<int>(size.x() / raster.cell_m) + 1;
  raster.rows = static_cast<int>(size.y() / raster.cell_m) + 1;
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      const auto sample = ground.sample(raster.south_west + raster.cell_m * Point2(column, row));
      raster.heights_m.push_back(sample ? sample->height
                                        : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return raster;
}

}  // namespace headland
