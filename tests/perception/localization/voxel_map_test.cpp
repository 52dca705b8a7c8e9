// SPDX-License-Identifier: Apache-2.0
#include "perception/localization/voxel_map.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

TEST(VoxelMap, APlaneTellsOfItsNormalOnly) {
  VoxelMap map(VoxelMapConfig{});
  RandomStream random(1, "plane");
  for (int i = 0; i < 200; ++i) {
    map.insert({static_cast<float>(random.uniform(-0.25, 0.25)),
                static_cast<float>(random.uniform(-0.25, 0.25)),
                static_cast<float>(0.1 + 0.01 * random.normal())});
  }
  const Voxel* voxel = map.find({0.1f, 0.2f, 0.2f});
  ASSERT_NE(voxel, nullptr);
  EXPECT_TRUE(voxel->informative);
  EXPECT_NEAR(voxel->mean.z(), 0.1f, 0.005f);
  EXPECT_GT(voxel->information(2, 2), 500.0f);
  EXPECT_LT(voxel->information(0, 0) + voxel->information(1, 1), 20.0f);
  EXPECT_EQ(map.find({0.1f, 0.2f, 0.4f}), nullptr);
  EXPECT_EQ(map.find_informative({0.1f, 0.2f, 0.4f}), voxel);
}

TEST(VoxelMap, ATrunkTellsOfItsPlaceAndNotOfItsHeight) {
  VoxelMap map(VoxelMapConfig{});
  for (int i = 0; i < 200; ++i) {
    const float around = 0.05f * static_cast<float>(i);
    map.insert({0.04f * std::cos(around), 0.5f + 0.04f * std::sin(around),
                0.25f + 0.0025f * static_cast<float>(i)});
  }
  const Voxel* voxel = map.find({0.0f, 0.5f, 0.5f});
  ASSERT_NE(voxel, nullptr);
  EXPECT_GT(voxel->information(0, 0), 200.0f);
  EXPECT_GT(voxel->information(1, 1), 200.0f);
  EXPECT_LT(voxel->information(2, 2), 20.0f);
}

TEST(VoxelMap, AnArcOnTheGroundAndFoliageTellNothing) {
  VoxelMap map(VoxelMapConfig{});
  RandomStream random(2, "foliage");
  for (int i = 0; i < 200; ++i) {
    map.insert({0.0025f * static_cast<float>(i) - 0.25f, 0.1f, 0.1f});
    map.insert({static_cast<float>(random.uniform(1.75, 2.25)),
                static_cast<float>(random.uniform(-0.25, 0.25)),
                static_cast<float>(random.uniform(-0.25, 0.25))});
  }
  ASSERT_NE(map.find({0.1f, 0.1f, 0.1f}), nullptr);
  EXPECT_FALSE(map.find({0.1f, 0.1f, 0.1f})->informative);
  EXPECT_FALSE(map.find({2.1f, 0.1f, 0.1f})->informative);
}

TEST(VoxelMap, ForgetsWhatIsFarAndStaysBounded) {
  VoxelMapConfig config;
  config.radius_m = 20.0;
  config.most_count = 4000;
  VoxelMap map(config);
  RandomStream random(3, "far");
  for (int scan = 0; scan < 50; ++scan) {
    const auto x = static_cast<float>(10 * scan);
    for (int i = 0; i < 1000; ++i) {
      map.insert({x + static_cast<float>(random.uniform(-15.0, 15.0)),
                  static_cast<float>(random.uniform(-15.0, 15.0)), 0.1f});
    }
    map.insert({x, 0.1f, 3.0f});
    map.end_scan({x, 0.0f, 0.0f});
    EXPECT_LE(map.size(), 4000);
    EXPECT_NE(map.find({x, 0.1f, 3.0f}), nullptr);
  }
  EXPECT_EQ(map.find({0.0f, 0.1f, 3.0f}), nullptr);
}

}  // namespace
}  // namespace headland
