// SPDX-License-Identifier: Apache-2.0
#include "perception/cloud/cloud.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace headland {
namespace {

std::vector<LidarPoint> points_at(std::initializer_list<Eigen::Vector3f> places) {
  std::vector<LidarPoint> points;
  for (const Eigen::Vector3f& place : places) {
    points.push_back({place, 0.5f, 0.01f * static_cast<float>(points.size()), 3});
  }
  return points;
}

TEST(Cloud, CropKeepsWhatLiesWithinAndMovesItToBase) {
  SensorMount mount;
  mount.x_m = 1.0;
  mount.z_m = 1.5;
  mount.yaw_deg = 90.0;
  const auto points = points_at({{2, 0, -1}, {0.1f, 0, 0}, {60, 0, 0}, {3, 0, 5}});
  std::vector<LidarPoint> out;
  crop_to_base(points, mount.pose(), CropConfig{}, out);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_LT((out[0].position - Eigen::Vector3f(1.0f, 2.0f, 0.5f)).norm(), 1e-6f);
  EXPECT_EQ(out[0].ring, 3);
}

TEST(Cloud, AnUpsideDownLidarSeesTheSameWorld) {
  SensorMount mount;
  mount.z_m = 1.5;
  mount.roll_deg = 180.0;
  std::vector<LidarPoint> out;
  crop_to_base(points_at({{5, 1, 1}}), mount.pose(), CropConfig{}, out);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_LT((out[0].position - Eigen::Vector3f(5.0f, -1.0f, 0.5f)).norm(), 1e-6f);
}

TEST(Cloud, NumbersThatAreNoneAreDropped) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  std::vector<LidarPoint> out(5);
  crop_to_base(points_at({{nan, 1, 1}, {5, inf, 0}, {5, 1, nan}}), Eigen::Isometry3d::Identity(),
               CropConfig{}, out);
  EXPECT_TRUE(out.empty());
}

}  // namespace
}  // namespace headland
