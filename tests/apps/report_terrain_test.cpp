// SPDX-License-Identifier: Apache-2.0
#include "apps/report_terrain.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace headland {
namespace {

TEST(TerrainRaster, SamplesTheGroundFromItsSouthWest) {
  // A plane that rises by 1 m per 10 m to the east, on [0, 100] x [0, 50].
  std::vector<double> heights;
  for (int row = 0; row <= 50; ++row) {
    for (int column = 0; column <= 100; ++column) heights.push_back(0.1 * column);
  }
  const Ground ground(Farm{}, Terrain::from_grid({0.0, 0.0}, 1.0, 101, 51, heights));
  const ReportTerrain raster =
      terrain_raster(ground, MapBox(Point2(-5.0, 10.0), Point2(95.0, 40.0)));
  EXPECT_EQ(raster.cell_m, 1.0) << "no finer than the terrain";
  EXPECT_EQ(raster.columns, 101);
  EXPECT_EQ(raster.rows, 31);
  ASSERT_EQ(raster.heights_m.size(), 101U * 31U);
  EXPECT_TRUE(std::isnan(raster.heights_m[0])) << "west of the terrain";
  EXPECT_NEAR(raster.heights_m[25], 2.0, 1e-6);
  EXPECT_NEAR(raster.heights_m[101 * 30 + 95], 9.0, 1e-6);
}

TEST(TerrainRaster, KeepsToItsSizeHoweverLargeTheFarm) {
  const ReportTerrain raster =
      terrain_raster(Ground(), MapBox(Point2(0.0, 0.0), Point2(5000.0, 2000.0)));
  EXPECT_LE(raster.columns, kMostTerrainPoints);
  EXPECT_GE(raster.columns, kMostTerrainPoints - 1);
  EXPECT_LT(raster.rows, raster.columns);
  EXPECT_TRUE(terrain_raster(Ground(), MapBox()).heights_m.empty());
}

}  // namespace
}  // namespace headland
