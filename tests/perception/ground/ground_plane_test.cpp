// SPDX-License-Identifier: Apache-2.0
#include "perception/ground/ground_plane.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "core/geometry/angle.hpp"
#include "perception/cloud/cloud.hpp"
#include "tests/perception/cloud/real_clouds.hpp"

namespace headland {
namespace {

float f(double x) { return static_cast<float>(x); }

// Ground z = height + pitch x + roll y with 2 cm noise.
void add_ground(int count, double height, double pitch, double roll, RandomStream& random,
                std::vector<LidarPoint>& points) {
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-12.0, 12.0);
    const double y = random.uniform(-12.0, 12.0);
    const double z = height + pitch * x + roll * y + 0.02 * random.normal();
    points.push_back({{f(x), f(y), f(z)}, 0.5f, 0.0f, 0});
  }
}

void add_box(int count, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
             RandomStream& random, std::vector<LidarPoint>& points) {
  for (int i = 0; i < count; ++i) {
    LidarPoint point;
    for (int axis = 0; axis < 3; ++axis) {
      point.position[axis] = f(random.uniform(low[axis], high[axis]));
    }
    points.push_back(point);
  }
}

TEST(GroundPlane, IsFoundOnSlopesToAFewMillimetres) {
  for (const double pitch : {-0.2, 0.0, 0.1}) {
    for (const double roll : {-0.1, 0.15}) {
      RandomStream random(1, "ground");
      std::vector<LidarPoint> points;
      add_ground(3000, 0.05, pitch, roll, random, points);
      const GroundPlane plane = fit_ground_plane(points);
      ASSERT_TRUE(plane.valid);
      const Eigen::Vector3d truth = Eigen::Vector3d(-pitch, -roll, 1.0).normalized();
      EXPECT_LT(std::acos(std::min(1.0, plane.normal.dot(truth))), 0.002);
      EXPECT_NEAR(plane.height_above({0.0, 0.0, 0.05}), 0.0, 0.005);
      EXPECT_NEAR(plane.normal.norm(), 1.0, 1e-9);
      EXPECT_GT(plane.inlier_ratio, 0.99);
    }
  }
}

// Ten times more points in a flat canopy at the sensor's height, and in one just below half of it.
TEST(GroundPlane, IsNeverTheCanopy) {
  for (const double height : {1.5, 0.6}) {
    RandomStream random(2, "ground");
    std::vector<LidarPoint> points;
    add_ground(400, 0.0, 0.02, 0.0, random, points);
    add_ground(4000, height, 0.0, 0.0, random, points);
    GroundPlaneConfig config;
    config.least_inlier_ratio = 0.05;
    const GroundPlane plane = fit_ground_plane(points, config);
    ASSERT_TRUE(plane.valid);
    EXPECT_NEAR(plane.offset_m, 0.0, 0.02);
    EXPECT_NEAR(plane.normal.x(), -0.02, 0.01);
  }
}

TEST(GroundPlane, IsNeverAWall) {
  RandomStream random(3, "ground");
  std::vector<LidarPoint> points;
  add_box(5000, {-10.0, 2.0, -0.3}, {10.0, 2.02, 3.0}, random, points);
  EXPECT_FALSE(fit_ground_plane(points).valid);
  add_ground(600, 0.0, 0.0, 0.0, random, points);
  const GroundPlane plane = fit_ground_plane(points);
  ASSERT_TRUE(plane.valid);
  EXPECT_GT(plane.normal.z(), 0.999);
}

TEST(GroundPlane, FollowsGravityWhereBaseIsTilted) {
  RandomStream random(4, "ground");
  std::vector<LidarPoint> points;
  const double slope = std::tan(deg_to_rad(25.0));
  add_ground(2000, 0.0, slope, 0.0, random, points);
  EXPECT_FALSE(fit_ground_plane(points).valid) << "steeper than the tolerance";
  const Eigen::Vector3d up = Eigen::Vector3d(-slope, 0.0, 1.0).normalized();
  EXPECT_TRUE(fit_ground_plane(points, {}, up).valid);
}

TEST(GroundPlane, BadInputHasNoPlane) {
  EXPECT_FALSE(fit_ground_plane({}).valid);
  std::vector<LidarPoint> points(100);
  for (LidarPoint& point : points) {
    point.position.setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  EXPECT_FALSE(fit_ground_plane(points).valid) << "NaN";
  for (LidarPoint& point : points) point.position.setZero();
  EXPECT_FALSE(fit_ground_plane(points).valid) << "one place";
  for (int i = 0; i < 100; ++i) points[static_cast<std::size_t>(i)].position = {f(0.1 * i), 0, 0};
  EXPECT_FALSE(fit_ground_plane(points).valid) << "a line";
  RandomStream random(5, "ground");
  points.clear();
  add_box(3000, {-10, -10, -3}, {10, 10, 0.7}, random, points);
  EXPECT_FALSE(fit_ground_plane(points).valid) << "a cloud without any plane";
  points.clear();
  add_ground(3000, -1.5, 0.0, 0.0, random, points);
  EXPECT_FALSE(fit_ground_plane(points).valid) << "not where base stands";
}

// One ring on flat ground is a circle: enough for a plane.
TEST(GroundPlane, OneRingIsEnough) {
  std::vector<LidarPoint> points;
  for (int i = 0; i < 360; ++i) {
    const double angle = deg_to_rad(i);
    points.push_back({{f(6.0 * std::cos(angle)), f(6.0 * std::sin(angle)), 0.0f}, 0, 0, 0});
  }
  const GroundPlane plane = fit_ground_plane(points);
  ASSERT_TRUE(plane.valid);
  EXPECT_NEAR(plane.normal.z(), 1.0, 1e-6);
}

TEST(GroundPlane, IsRepeatable) {
  RandomStream random(6, "ground");
  std::vector<LidarPoint> points;
  add_ground(500, 0.0, 0.0, 0.0, random, points);
  add_box(500, {-5, -5, 0}, {5, 5, 2}, random, points);
  const GroundPlane first = fit_ground_plane(points);
  const GroundPlane second = fit_ground_plane(points);
  EXPECT_EQ(first.normal, second.normal);
  EXPECT_EQ(first.offset_m, second.offset_m);
}

struct RealScan {
  const char* name;
  double mount_height;   // of the origin of its points above the ground [m]
  double sensor_height;  // [m]
  double most_tilt_deg;  // the scan pair stands on a slope
};
class GroundPlaneOfRealScan : public ::testing::TestWithParam<RealScan> {};

TEST_P(GroundPlaneOfRealScan, IsLevelAndBelowTheSensor) {
  const auto file = real_cloud(GetParam().name);
  if (!file) GTEST_SKIP() << "no data";
  const auto scan = load_cloud(*file);
  ASSERT_TRUE(scan);
  SensorMount mount;
  mount.z_m = GetParam().mount_height;
  std::vector<LidarPoint> points;
  crop_to_base(scan->points, mount.pose(), CropConfig{}, points);
  GroundPlaneConfig config;
  config.sensor_height_m = GetParam().sensor_height;
  const GroundPlane plane = fit_ground_plane(points, config);
  EXPECT_TRUE(plane.valid);
  EXPECT_GT(plane.normal.z(), std::cos(deg_to_rad(GetParam().most_tilt_deg)))
      << plane.normal.transpose();
  EXPECT_GT(plane.inlier_ratio, 0.3);
  RecordProperty("offset_m", std::to_string(plane.offset_m));
}

// The plane of PCL without constraints is a wall in the scan pair.
INSTANTIATE_TEST_SUITE_P(All, GroundPlaneOfRealScan,
                         ::testing::Values(RealScan{"kitti_000000/velodyne_000000.bin", 1.73, 1.73,
                                                    2.0},
                                           RealScan{"ring128/000000.pcd", 0.1, 1.8, 2.0},
                                           RealScan{"scan_pair/source.ply", 1.9, 1.9, 7.0},
                                           RealScan{"scan_pair/target.ply", 1.9, 1.9, 7.0}));

}  // namespace
}  // namespace headland
