// SPDX-License-Identifier: Apache-2.0
#include "perception/cloud/voxel_thinning.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

std::vector<LidarPoint> random_points(int count, double reach) {
  RandomStream random(3, "points");
  std::vector<LidarPoint> points;
  for (int i = 0; i < count; ++i) {
    LidarPoint point;
    for (int axis = 0; axis < 3; ++axis) {
      point.position[axis] = static_cast<float>(random.uniform(-reach, reach));
    }
    point.intensity = static_cast<float>(random.uniform());
    point.ring = static_cast<std::uint16_t>(i);
    points.push_back(point);
  }
  return points;
}

TEST(VoxelThinning, GivesTheMeanOfEachVoxel) {
  const auto points = random_points(5000, 1.0);
  std::map<std::array<int, 3>, std::pair<Eigen::Vector3d, int>> voxels;
  for (const LidarPoint& point : points) {
    const Eigen::Vector3f scaled = point.position * (1.0f / 0.25f);
    auto& [sum, count] = voxels
                             .try_emplace({static_cast<int>(std::floor(scaled.x())),
                                           static_cast<int>(std::floor(scaled.y())),
                                           static_cast<int>(std::floor(scaled.z()))},
                                          Eigen::Vector3d::Zero(), 0)
                             .first->second;
    sum += point.position.cast<double>();
    ++count;
  }
  std::vector<LidarPoint> out;
  VoxelThinning(0.25).thin(points, out);
  ASSERT_EQ(out.size(), voxels.size());
  EXPECT_EQ(out[0].ring, 0) << "the ring of the first";
  for (const LidarPoint& point : out) {
    const Eigen::Vector3f scaled = point.position * (1.0f / 0.25f);
    const auto& [sum, count] = voxels.at({static_cast<int>(std::floor(scaled.x())),
                                          static_cast<int>(std::floor(scaled.y())),
                                          static_cast<int>(std::floor(scaled.z()))});
    EXPECT_LT((point.position.cast<double>() - sum / count).norm(), 1e-5);
  }
}

TEST(VoxelThinning, FarAndInvalidPointsAreLeftOutAndNearOnesNot) {
  std::vector<LidarPoint> points(4);
  points[0].position = {std::numeric_limits<float>::quiet_NaN(), 0, 0};
  points[1].position = {0, std::numeric_limits<float>::infinity(), 0};
  points[2].position = {0, 0, -2e5f};
  points[3].position = {9e4f, -9e4f, 1};  // beyond what 32-bit indices of voxels reach
  std::vector<LidarPoint> out;
  VoxelThinning thinning(0.1);
  thinning.thin(points, out);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].position, points[3].position);
  thinning.thin({}, out);
  EXPECT_TRUE(out.empty());
}

TEST(VoxelThinning, RefusesVoxelsOfNoSize) {
  EXPECT_THROW(VoxelThinning(0.0), std::invalid_argument);
  EXPECT_THROW(VoxelThinning(-1.0), std::invalid_argument);
  EXPECT_THROW(VoxelThinning(std::nan("")), std::invalid_argument);
}

TEST(VoxelThinning, DoesNotAllocateOnceWarm) {
  const auto points = random_points(2000, 2.0);
  VoxelThinning thinning(0.1);
  std::vector<LidarPoint> out;
  thinning.thin(points, out);
  const std::vector<LidarPoint> first = out;
  const auto before = testing::allocation_count();
  thinning.thin(points, out);
  EXPECT_EQ(testing::allocation_count(), before);
  ASSERT_EQ(out.size(), first.size());
}

}  // namespace
}  // namespace headland
