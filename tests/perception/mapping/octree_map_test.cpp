// SPDX-License-Identifier: Apache-2.0
#include "perception/mapping/octree_map.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

std::filesystem::path scratch(const std::string& name) {
  return std::filesystem::temp_directory_path() /
         ("headland_" + std::to_string(::getpid()) + "_" + name);
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Removed first: some file systems make overwriting wait for the disk.
void replace(const std::filesystem::path& file, const std::string& content) {
  std::filesystem::remove(file);
  std::ofstream(file, std::ios::binary) << content;
}

std::vector<LidarPoint> ring() {
  std::vector<LidarPoint> points;
  for (double angle = 0.0; angle < 6.28; angle += 0.02) {
    points.push_back({{static_cast<float>(6.0 * std::cos(angle)),
                       static_cast<float>(6.0 * std::sin(angle)), 0.1f},
                      0,
                      0,
                      0});
  }
  return points;
}

TEST(OctreeMap, ARayClearsAndItsEndIsOccupied) {
  OctreeMap map;
  const std::vector<LidarPoint> points{{{5.1f, 0.1f, 0.1f}, 0, 0, 0}};
  map.insert(points, {0.1, 0.1, 0.1});
  EXPECT_EQ(map.occupied({5.1, 0.1, 0.1}), true);
  EXPECT_NEAR(*map.probability({5.1, 0.1, 0.1}), 0.7, 1e-6);
  EXPECT_EQ(map.occupied({2.1, 0.1, 0.1}), false);
  EXPECT_NEAR(*map.probability({2.1, 0.1, 0.1}), 0.4, 1e-6);
  EXPECT_FALSE(map.occupied({7.1, 0.1, 0.1}));
  EXPECT_FALSE(map.occupied({1e9, 0.0, 0.0})) << "outside of the tree";
  EXPECT_FALSE(map.occupied({std::nan(""), 0.0, 0.0}));
}

TEST(OctreeMap, FilesKeepWhatIsKnown) {
  OctreeMapConfig config;
  config.cell_m = 0.15;
  OctreeMap map(config);
  map.insert(ring(), {0.0, 0.0, 0.1});
  for (const char* extension : {".bt", ".ot"}) {
    const auto file = scratch(std::string("map") + extension);
    ASSERT_FALSE(map.write(file));
    const auto read = OctreeMap::read(file);
    std::filesystem::remove(file);
    ASSERT_TRUE(read) << to_string(read.error());
    EXPECT_NEAR(read->cell(), 0.15, 1e-9);
    for (double x = -6.5; x < 6.5; x += 0.1) {
      for (double y = -6.5; y < 6.5; y += 0.1) {
        ASSERT_EQ(read->occupied({x, y, 0.1}), map.occupied({x, y, 0.1}));
      }
    }
  }
}

TEST(OctreeMap, MaskedPointsNeitherMarkNorClear) {
  OctreeMap map;
  const std::vector<LidarPoint> points{{{5.1f, 0.1f, 0.1f}, 0, 0, 0}};
  const MaskedDisc disc{{5.0, 0.0}, 0.5};
  map.insert(points, {0.0, 0.0, 0.0}, std::span(&disc, 1));
  EXPECT_EQ(map.node_count(), 0u);
}

TEST(OctreeMap, BadPointsAreLeftOut) {
  OctreeMap map;
  std::vector<LidarPoint> points(2);
  points[0].position = {std::numeric_limits<float>::quiet_NaN(), 0, 0};
  points[1].position = {0, std::numeric_limits<float>::infinity(), 0};
  map.insert(points, {0.0, 0.0, 0.0});
  map.insert(ring(), {std::nan(""), 0.0, 0.0});
  EXPECT_EQ(map.node_count(), 0u);
}

TEST(OctreeMap, FilesThatAreNoneAreRefused) {
  EXPECT_EQ(OctreeMap::read("/nowhere/map.bt").error().code, ErrorCode::kFileNotFound);
  EXPECT_EQ(OctreeMap::read("map.pcd").error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(OctreeMap().write("/nowhere/map.bt")->code, ErrorCode::kFileNotWritable);
  EXPECT_EQ(OctreeMap().write("map.pcd")->code, ErrorCode::kUnsupported);
  const auto file = scratch("other.ot");
  std::ofstream(file) << "# Octomap OcTree file\nid ColorOcTree\nsize 1\nres 0.1\ndata\n";
  EXPECT_EQ(OctreeMap::read(file).error().code, ErrorCode::kUnsupported);
  std::filesystem::remove(file);
}

// Files cut short anywhere, or with wrong bytes, are refused or read, never more.
TEST(OctreeMap, DamagedFilesBringNothingDown) {
  OctreeMap map;
  map.insert(std::vector<LidarPoint>{{{2.1f, 0.1f, 0.1f}, 0, 0, 0}}, {0.0, 0.0, 0.0});
  RandomStream random(1, "damage");
  for (const char* extension : {".bt", ".ot"}) {
    const auto file = scratch(std::string("damaged") + extension);
    ASSERT_FALSE(map.write(file));
    const std::string whole = content_of(file);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      replace(file, whole.substr(0, size));
      EXPECT_FALSE(OctreeMap::read(file)) << size << " of " << whole.size();
    }
    for (int i = 0; i < 300; ++i) {
      std::string damaged = whole;
      damaged[static_cast<std::size_t>(random.index(static_cast<int>(whole.size())))] =
          static_cast<char>(random.index(256));
      replace(file, damaged);
      const auto read = OctreeMap::read(file);
      if (read) {
        EXPECT_LT(read->node_count(), 10'000u);
      } else {
        EXPECT_EQ(exit_code(read.error().code), 2);
      }
    }
    std::filesystem::remove(file);
  }
}

}  // namespace
}  // namespace headland
