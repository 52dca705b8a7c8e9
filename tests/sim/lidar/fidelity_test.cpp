// SPDX-License-Identifier: Apache-2.0
// Simulated scans beside the statistics of six real 16-beam scans from within a vineyard (front
// half turn at 0.35 deg, sensor 1.45 m up, rows about 2.5 m apart): 4.8 to 6.7 thousand returns,
// median range 4.1 to 7.9 m, 95th percentile 12.6 to 25.3 m, 32 to 57 % within 0.2 m of the ground.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "sim/lidar/lidar.hpp"

namespace headland {
namespace {

namespace fs = std::filesystem;

constexpr double kHeight = 1.45;

struct Span {
  double low = 1e9;
  double high = -1e9;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

struct Figures {
  Span returns;
  Span median;
  Span far;
  Span ground;  // [percent]
};

Figures figures_of(const char* name, const LidarScene& scene, double alley_y) {
  LidarConfig config;
  config.azimuth_step_deg = 0.35;
  config.view_begin_deg = -90.0;
  config.view_end_deg = 90.0;
  SensorMount mount;
  mount.z_m = kHeight;
  LidarSimulator lidar(config, mount, 7);
  LidarScan scan;
  Figures figures;
  for (int k = 0; k < 12; ++k) {
    const Pose2 pose{3.0 + 4.0 * k, alley_y - 0.3 + 0.055 * k, -0.06 + 0.011 * k};
    const Eigen::Isometry3d T_map_base = scene.pose_on_ground(pose);
    lidar.scan(
        scene, [&](double) { return T_map_base; }, 0.0, scan);
    std::vector<double> ranges;
    int ground = 0;
    for (const LidarPoint& point : scan.points) {
      ranges.push_back(static_cast<double>(point.position.norm()));
      if (std::abs(static_cast<double>(point.position.z()) + kHeight) < 0.2) ++ground;
    }
    if (ranges.empty()) return figures;
    std::sort(ranges.begin(), ranges.end());
    figures.returns.add(static_cast<double>(ranges.size()));
    figures.median.add(ranges[ranges.size() / 2]);
    figures.far.add(ranges[ranges.size() * 95 / 100]);
    figures.ground.add(100.0 * ground / static_cast<double>(ranges.size()));
  }
  std::printf("%s: returns %.0f to %.0f, median %.1f to %.1f m, 95 %% %.1f to %.1f m, ", name,
              figures.returns.low, figures.returns.high, figures.median.low, figures.median.high,
              figures.far.low, figures.far.high);
  std::printf("ground %.0f to %.0f %%\n", figures.ground.low, figures.ground.high);
  return figures;
}

void expect_within(const Span& span, double low, double high) {
  EXPECT_GE(span.low, low);
  EXPECT_LE(span.high, high);
}

LidarScene vineyard_scene(bool in_leaf) {
  RowLayout layout;
  layout.rows_count = 10;
  return LidarScene::rows(layout, vineyard(in_leaf), 1);
}

TEST(LidarFidelity, AVineyardInLeafScansLikeRealOnes) {
  const Figures leaf = figures_of("vineyard in leaf", vineyard_scene(true), 0.0);
  expect_within(leaf.returns, 4800.0, 6700.0);
  expect_within(leaf.median, 4.1, 7.9);
  expect_within(leaf.far, 12.6, 25.3);
  expect_within(leaf.ground, 32.0, 57.0);
}

TEST(LidarFidelity, BareRowsLetTheLidarSeeFartherAndMoreGround) {
  const Figures bare = figures_of("vineyard bare", vineyard_scene(false), 0.0);
  const Figures leaf = figures_of("vineyard in leaf", vineyard_scene(true), 0.0);
  EXPECT_GT(bare.ground.low, leaf.ground.high);
  EXPECT_GT(bare.far.low, leaf.far.high);
  expect_within(bare.returns, 4800.0, 6700.0);
  expect_within(bare.median, 4.1, 7.9);
}

TEST(LidarFidelity, AnOrchardHasTallerAndThickerWalls) {
  RowLayout layout;
  layout.rows_count = 10;
  layout.spacing_m = 3.8;
  layout.length_m = 130.0;
  const Figures leaf =
      figures_of("orchard in leaf", LidarScene::rows(layout, fruit_orchard(true), 1), 0.0);
  const Figures bare =
      figures_of("orchard bare", LidarScene::rows(layout, fruit_orchard(false), 1), 0.0);
  EXPECT_GT(leaf.returns.low, 6700.0);
  EXPECT_LT(leaf.ground.high, 30.0);
  EXPECT_GT(bare.ground.low, leaf.ground.high);
}

// x, y, z of a PCD file of packed floats.
std::vector<Eigen::Vector3f> read_points(const fs::path& file, std::size_t floats) {
  std::ifstream in(file, std::ios::binary);
  std::string line;
  while (std::getline(in, line) && line != "DATA binary") {
  }
  std::vector<Eigen::Vector3f> points;
  std::vector<float> fields(floats);
  while (in.read(reinterpret_cast<char*>(fields.data()),
                 static_cast<std::streamsize>(floats * sizeof(float)))) {
    points.emplace_back(fields[0], fields[1], fields[2]);
  }
  return points;
}

TEST(LidarFidelity, RealPinesCanBeTiledAlongRows) {
  const char* given = std::getenv("HEADLAND_DATA");
  const fs::path root = given ? given : std::string(HEADLAND_SOURCE_DIR) + "/../shared/data";
  const fs::path file = root / "lidar/pine_plot/pine_plot.pcd";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  const std::vector<Eigen::Vector3f> points = read_points(file, 5);
  ASSERT_EQ(points.size(), 114024u);
  // Rows of trunks run along y at these x.
  std::vector<CanopyStrip> strips;
  for (const double x : {0.43, 3.47, 6.34, 9.38}) strips.push_back(cut_strip(points, 0.5 * kPi, -x, 0.6));
  for (const CanopyStrip& strip : strips) EXPECT_GT(strip.size(), 3000u);
  RowLayout layout;
  layout.rows_count = 10;
  const LidarScene scene = LidarScene::tiled(layout, strips, vineyard(true), 1);
  const Figures pines = figures_of("real pines, 2.5 m rows", scene, 0.0);
  expect_within(pines.returns, 3500.0, 8000.0);
  EXPECT_GT(pines.ground.low, 10.0);
}

}  // namespace
}  // namespace headland
