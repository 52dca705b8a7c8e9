// SPDX-License-Identifier: Apache-2.0
#include "perception/mapping/rolling_grid.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "perception/mapping/octree_map.hpp"
#include "tests/perception/cloud/real_clouds.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

float f(double x) { return static_cast<float>(x); }

RollingGridConfig small_grid() {
  RollingGridConfig config;
  config.reach_m = 10.0;
  return config;
}

std::vector<LidarPoint> point_at(double x, double y, double z) {
  return {{{f(x), f(y), f(z)}, 0, 0, 0}};
}

// A wall across x = `x` from y = -3 to 3, 2 m high, on the ground z = -1.5 of the sensor.
void add_wall(double x, std::vector<LidarPoint>& points) {
  for (double y = -3.0; y <= 3.0; y += 0.05) {
    for (double z = -1.5; z < 0.5; z += 0.05) points.push_back({{f(x), f(y), f(z)}, 0, 0, 0});
  }
}

// A person of 0.3 m radius and 1.7 m height, the half that faces the sensor.
void add_person(double x, double y, std::vector<LidarPoint>& points) {
  for (double angle = 1.6; angle < 4.7; angle += 0.15) {
    for (double z = -1.4; z < 0.2; z += 0.05) {
      points.push_back(
          {{f(x + 0.3 * std::cos(angle)), f(y + 0.3 * std::sin(angle)), f(z)}, 0, 0, 0});
    }
  }
}

TEST(RollingGrid, ARayClearsAndItsEndIsOccupied) {
  RollingGrid grid(small_grid());
  grid.insert(point_at(5.05, 0.05, 0.05), {0.05, 0.05, 0.05}, 0.0);
  EXPECT_TRUE(grid.occupied({5.05, 0.05, 0.05}));
  EXPECT_NEAR(*grid.probability({5.05, 0.05, 0.05}), 0.7, 0.005);
  for (double x = 0.05; x < 5.0; x += 0.1) {
    ASSERT_TRUE(grid.probability({x, 0.05, 0.05})) << x;
    EXPECT_NEAR(*grid.probability({x, 0.05, 0.05}), 0.4, 0.005);
  }
  EXPECT_FALSE(grid.probability({5.15, 0.05, 0.05})) << "behind";
  EXPECT_FALSE(grid.probability({2.05, 0.25, 0.05})) << "beside";
  EXPECT_EQ(grid.occupied_cells().size(), 1u);
  EXPECT_LT((grid.occupied_cells()[0] - Eigen::Vector3d(5.05, 0.05, 0.05)).norm(), 1e-9);
}

// Along random rays: every place of the ray lies in a cell that it cleared, but near edges.
TEST(RollingGrid, RaysClearAllCellsThatTheyPass) {
  RandomStream random(1, "rays");
  for (int ray = 0; ray < 200; ++ray) {
    RollingGrid grid(small_grid());
    const Eigen::Vector3d from(random.uniform(-5, 5), random.uniform(-5, 5), 0.3);
    const Eigen::Vector3d step(random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-2, 3));
    const Eigen::Vector3d to = from + step;
    grid.insert(point_at(to.x(), to.y(), to.z()), from, 0.0);
    EXPECT_TRUE(grid.occupied(to.cast<float>().cast<double>()));
    for (double share = 0.0; share < 1.0; share += 0.003) {
      const Eigen::Vector3d place = from + share * step;
      const Eigen::Vector3d cells = place / 0.1;
      const Eigen::Vector3d to_edge = (cells.array() - cells.array().round()).abs();
      if (to_edge.minCoeff() < 0.01) continue;
      ASSERT_TRUE(grid.probability(place)) << ray << " at " << place.transpose();
    }
  }
}

TEST(RollingGrid, BoundsAreOctoMaps) {
  RollingGrid grid(small_grid());
  for (int i = 0; i < 50; ++i) grid.insert(point_at(5.05, 0.05, 0.05), {0, 0, 0}, 0.1 * i);
  EXPECT_NEAR(*grid.probability({5.05, 0.05, 0.05}), 0.971, 0.002);
  EXPECT_NEAR(*grid.probability({2.05, 0.02, 0.02}), 0.1192, 0.002);
  // From the upper bound some passing rays are enough to clear a cell.
  int scans = 0;
  for (; grid.occupied({5.05, 0.05, 0.05}); ++scans) {
    grid.insert(point_at(9.09, 0.09, 0.09), {0, 0, 0}, 5.0);
    ASSERT_LT(scans, 20);
  }
  EXPECT_EQ(scans, 9) << "3.5 / 0.4";
}

TEST(RollingGrid, OccupiedWinsWithinAScan) {
  std::vector<LidarPoint> points = point_at(5.05, 0.05, 0.05);
  for (int i = 0; i < 20; ++i) points.push_back({{9.0f, 0.09f, 0.09f}, 0, 0, 0});
  RollingGrid grid(small_grid());
  grid.insert(points, {0, 0, 0}, 0.0);
  EXPECT_NEAR(*grid.probability({5.05, 0.05, 0.05}), 0.7, 0.005) << "and counts once";
}

TEST(RollingGrid, TrackedAgentsLeaveNoGhosts) {
  RollingGrid grid(small_grid());
  RollingGrid unmasked(small_grid());
  const Eigen::Vector3d origin(0.0, 0.0, 0.0);
  for (int scan = 0; scan < 30; ++scan) {
    const double y = -3.0 + 0.2 * scan;  // walks by, 5 m ahead, nothing behind returns
    std::vector<LidarPoint> points;
    add_person(5.0, y, points);
    const MaskedDisc disc{{5.0, y}, 0.5};
    grid.insert(points, origin, 0.1 * scan, std::span(&disc, 1));
    unmasked.insert(points, origin, 0.1 * scan);
  }
  EXPECT_TRUE(grid.occupied_cells().empty());
  EXPECT_GT(unmasked.occupied_cells().size(), 500u);
  EXPECT_FALSE(grid.probability({2.0, 0.0, 0.0})) << "nor do they clear";
}

TEST(RollingGrid, TheBoxMovesAndCellsKeepTheirPlace) {
  RollingGrid grid(small_grid());
  std::vector<LidarPoint> wall;
  add_wall(5.03, wall);
  grid.insert(wall, {0.0, 0.0, 0.0}, 0.0);
  const auto before = grid.occupied_cells();
  for (const Eigen::Vector3d& origin :
       {Eigen::Vector3d(3.3, -2.7, 0.2), {-2.2, 1.1, 0.9}, {0.7, 0.1, -0.6}, {0.0, 0.0, 0.0}}) {
    grid.insert({}, origin, 1.0);
    EXPECT_TRUE(grid.occupied({5.03, 0.02, -0.98})) << origin.transpose();
  }
  EXPECT_GT(grid.occupied_cells().size(), before.size() * 7 / 10)
      << "only layers that left are gone";
  grid.insert({}, {0.0, 0.0, 50.0}, 2.0);
  EXPECT_TRUE(grid.occupied_cells().empty());
  grid.insert(wall, {0.0, 0.0, 0.0}, 3.0);
  grid.insert({}, {500.0, 0.0, 0.0}, 4.0);
  grid.insert({}, {0.0, 0.0, 0.0}, 5.0);
  EXPECT_TRUE(grid.occupied_cells().empty()) << "what has left is forgotten";
}

TEST(RollingGrid, ForgetsWhatIsOutOfView) {
  RollingGridConfig config = small_grid();
  config.memory_s = 10.0;
  RollingGrid grid(config);
  for (int i = 0; i < 10; ++i) grid.insert(point_at(5.05, 0.05, 0.05), {0, 0, 0}, 0.1 * i);
  grid.insert({}, {0, 0, 0}, 5.0);
  EXPECT_TRUE(grid.occupied({5.05, 0.05, 0.05}));
  grid.insert({}, {0, 0, 0}, 1.0);
  EXPECT_TRUE(grid.occupied({5.05, 0.05, 0.05})) << "time that runs backwards stands still";
  for (int i = 0; i < 60; ++i) grid.insert({}, {0, 0, 0}, 5.1 + 0.1 * i);
  EXPECT_FALSE(grid.probability({5.05, 0.05, 0.05}));
}

TEST(RollingGrid, ClearanceIsThatOfWhatStandsOnTheGround) {
  std::vector<LidarPoint> ground;
  for (double x = -9.0; x < 9.0; x += 0.1) {
    for (double y = -9.0; y < 9.0; y += 0.1) ground.push_back({{f(x), f(y), -1.5f}, 0, 0, 0});
  }
  HeightGrid heights;
  heights.update(ground, {0.0, 0.0});
  std::vector<LidarPoint> points = ground;
  add_wall(5.05, points);
  for (double y = -3.0; y < 3.0; y += 0.05) points.push_back({{-5.05f, f(y), 1.5f}, 0, 0, 0});
  RollingGrid grid(small_grid());
  grid.insert(points, {0.0, 0.0, 0.0}, 0.0);
  const ClearanceMap map = grid.clearance_map(heights);
  EXPECT_EQ(map.clearance({5.05, 0.0}), 0.0);
  EXPECT_NEAR(map.clearance({3.0, 0.0}), 2.0, 0.3);
  EXPECT_GT(map.clearance({-5.05, 0.0}), 5.0) << "a branch above the vehicle";
  EXPECT_EQ(grid.clearance_map(HeightGrid{}).clearance({-5.05, 0.0}), 0.0)
      << "where no ground is known all that is occupied counts";
}

TEST(RollingGrid, BadInputChangesNothing) {
  RollingGrid grid(small_grid());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  grid.insert(point_at(1.0, 0.0, 0.0), {std::nan(""), 0.0, 0.0}, 0.0);
  grid.insert(point_at(1.0, 0.0, 0.0), {1e300, 0.0, 0.0}, 0.0);
  std::vector<LidarPoint> points(3);
  points[0].position = {nan, 0, 0};
  points[1].position = {std::numeric_limits<float>::infinity(), 0, 0};
  points[2].position = {3e38f, 3e38f, 3e38f};
  grid.insert(points, {0.0, 0.0, 0.0}, std::nan(""));
  EXPECT_TRUE(grid.occupied_cells().empty());
  EXPECT_FALSE(grid.probability({std::nan(""), 0.0, 0.0}));
  grid.insert(point_at(30.0, 0.05, 0.05), {0.05, 0.05, 0.05}, 0.0);
  EXPECT_TRUE(grid.occupied_cells().empty()) << "a far return marks nothing";
  EXPECT_TRUE(grid.probability({9.5, 0.05, 0.05})) << "but clears up to the reach";
}

TEST(RollingGrid, DoesNotAllocate) {
  RollingGrid grid(small_grid());
  std::vector<LidarPoint> points;
  add_wall(5.05, points);
  const long before = testing::allocation_count();
  grid.insert(points, {0.0, 0.0, 0.0}, 0.0);
  grid.insert(points, {0.5, 0.5, 0.7}, 0.1);
  EXPECT_EQ(testing::allocation_count(), before);
}

// Same cells, same states as OctoMap's own insertion, but where rounding moves a ray to the cell
// beside.
TEST(RollingGrid, AgreesWithOctoMapOnARealScan) {
  const auto file = real_cloud("kitti_000000/velodyne_000000.bin");
  if (!file) GTEST_SKIP() << "no data";
  const auto scan = load_cloud(*file);
  ASSERT_TRUE(scan);
  std::vector<LidarPoint> points;
  for (std::size_t i = 0; i < scan->points.size(); i += 20) points.push_back(scan->points[i]);
  RollingGridConfig config;
  config.cell_m = 0.2;
  config.reach_m = 20.0;
  RollingGrid grid(config);
  OctreeMapConfig octree_config;
  octree_config.cell_m = 0.2;
  octree_config.range_m = 20.0;
  OctreeMap octree(octree_config);
  grid.insert(points, {0.0, 0.0, 0.0}, 0.0);
  octree.insert(points, {0.0, 0.0, 0.0});
  int seen = 0;
  int different = 0;
  for (double x = -19.9; x < 20.0; x += 0.2) {
    for (double y = -19.9; y < 20.0; y += 0.2) {
      for (double z = -2.3; z < 4.0; z += 0.2) {
        const auto ours = grid.probability({x, y, z});
        const auto theirs = octree.occupied({x, y, z});
        if (!ours && !theirs) continue;
        ++seen;
        different += ours && theirs ? (*ours > 0.5) != *theirs : 1;
      }
    }
  }
  EXPECT_GT(seen, 10000);
  EXPECT_LT(different, seen / 200);
}

}  // namespace
}  // namespace headland
