// SPDX-License-Identifier: Apache-2.0
#include "apps/scan_look.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "sim/lidar/lidar.hpp"
#include "sim/lidar/scene.hpp"

namespace headland::apps {
namespace {

constexpr double kAside = 0.2;    // of the lane's middle, to the left [m]
constexpr double kTurned = 0.05;  // to the left [rad]
constexpr double kHeight = 1.3;   // of the sensor [m]

// A scan in the sensor's frame, by a robot in the middle of a block; `half`: the front alone.
LidarScan scan_of(double spacing, const OrchardConfig& plants, bool half, double roll_deg = 0.0) {
  RowLayout layout;
  layout.spacing_m = spacing;
  const LidarScene scene = LidarScene::rows(layout, plants, 3);
  SensorMount mount;
  mount.z_m = kHeight;
  mount.roll_deg = roll_deg;
  LidarConfig lidar;
  if (half) {
    lidar.view_begin_deg = -90.0;
    lidar.view_end_deg = 90.0;
  }
  LidarScan scan;
  const Eigen::Isometry3d pose = scene.pose_on_ground({30.0, kAside, kTurned});
  LidarSimulator(lidar, mount, 5)
      .scan(
          scene, [&](double) { return pose; }, 0.0, scan);
  return scan;
}

void expect_lane(const ScanLook& look, double width) {
  ASSERT_TRUE(look.row.valid);
  EXPECT_NEAR(look.row.offset_m, -kAside * std::cos(kTurned), 0.1);
  EXPECT_NEAR(look.row.heading_rad, -kTurned, 0.02);
  EXPECT_NEAR(look.row.width_m, width, 0.25);
  EXPECT_NEAR(look.sensor_height_m, kHeight, 0.1);
  EXPECT_FALSE(look.row.row_end.seen);
  EXPECT_FALSE(look.clusters.empty());
}

TEST(ScanLook, FindsTheRowWithoutKnowingHeightOrWidth) {
  expect_lane(look_at(scan_of(2.5, vineyard(true), false), {}), 2.5);
  expect_lane(look_at(scan_of(2.5, vineyard(true), true), {}), 2.5);
  expect_lane(look_at(scan_of(3.8, fruit_orchard(false), false), {}), 3.8);
}

TEST(ScanLook, AnUpsideDownLidarSeesTheSameRow) {
  ScanLookConfig config;
  config.mount.roll_deg = 180.0;
  config.mount.z_m = kHeight;
  expect_lane(look_at(scan_of(2.5, vineyard(true), false, 180.0), config), 2.5);
}

TEST(ScanLook, WhatIsNoRowIsNotInvented) {
  LidarScan nothing;
  EXPECT_FALSE(look_at(nothing, {}).row.valid);
  LidarScan ring;  // one laser
  for (int i = 0; i < 1800; ++i) {
    const double angle = 2.0 * kPi * i / 1800.0;
    ring.points.push_back({{static_cast<float>(5.0 * std::cos(angle)),
                            static_cast<float>(5.0 * std::sin(angle)), -1.3f}});
  }
  EXPECT_FALSE(look_at(ring, {}).row.valid);
  LidarScan wall;  // on one side, beside plain ground
  for (int i = 0; i < 200; ++i) {
    for (int k = 0; k < 20; ++k) {
      const auto x = static_cast<float>(0.1 * i - 10.0);
      wall.points.push_back({{x, 1.2f, static_cast<float>(0.15 * k - 1.3)}});
      wall.points.push_back({{x, static_cast<float>(0.3 * k - 4.8), -1.3f}});
    }
  }
  EXPECT_FALSE(look_at(wall, {}).row.valid);
  LidarScan broken = scan_of(2.5, vineyard(true), false);
  for (LidarPoint& p : broken.points) p.position.x() = std::numeric_limits<float>::quiet_NaN();
  const ScanLook look = look_at(broken, {});
  EXPECT_FALSE(look.row.valid);
  EXPECT_FALSE(look.ground.valid);
}

}  // namespace
}  // namespace headland::apps
