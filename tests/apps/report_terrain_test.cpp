// SPDX-License-Identifier: Apache-2.0
#include "apps/report_terrain.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace headland {
namespace {

std::string encoded(std::string_view text) { return base64({text.begin(), text.end()}); }

TEST(Base64, WritesTheExamplesOfRfc4648) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64({255, 254, 0}), "//4A");
}

TEST(PackedHeights, RunFromTheLowestToTheHighestAndMarkGaps) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const PackedHeights packed = pack({100.0, none, 120.0, 110.0});
  EXPECT_EQ(packed.low_m, 100.0);
  EXPECT_EQ(packed.high_m, 120.0);
  // 0, 65535, 65534, 32767
  EXPECT_EQ(packed.base64, base64({0, 0, 255, 255, 254, 255, 255, 127}));
  EXPECT_EQ(pack({5.0, 5.0}).base64, base64({0, 0, 0, 0}));
  EXPECT_EQ(pack({none}).base64, base64({255, 255}));
  EXPECT_EQ(pack({}).base64, "");
}

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
