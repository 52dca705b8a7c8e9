// SPDX-License-Identifier: Apache-2.0
#include "perception/localization/lidar_odometry.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "perception/localization/internal/rotation.hpp"
#include "tests/perception/localization/ray_world.hpp"

namespace headland {
namespace {

using testing::RayWorld;
using Filter = internal::InertialFilter;

const float kNan = std::numeric_limits<float>::quiet_NaN();

LidarOdometryConfig at_height(double height) {
  LidarOdometryConfig config;
  config.lidar.z_m = height;
  config.imu.z_m = 0.5;
  config.imu.x_m = 0.2;
  return config;
}

Eigen::Isometry3d pose3(const Pose2& pose) {
  return Eigen::Translation3d(pose.x, pose.y, 0.0) *
         Eigen::AngleAxisd(pose.yaw, Eigen::Vector3d::UnitZ());
}

/// Drives with a speed and a yaw rate by time, scans at 10 Hz, and gives the error of the pose.
struct Drive {
  explicit Drive(const RayWorld& seen) : world(seen) {}

  const RayWorld& world;
  LidarOdometryConfig config = at_height(1.5);
  bool imu = true;
  bool wheels = true;
  double seconds = 10.0;
  std::function<double(double)> speed = [](double) { return 1.0; };
  std::function<double(double)> yaw_rate = [](double) { return 0.0; };

  Pose2 true_pose;
  double driven = 0.0;
  OdometryEstimate last;

  void run() {
    LidarOdometry odometry(config);
    RandomStream random(7, "drive");
    if (imu) {
      for (int i = 0; i < 20; ++i) odometry.add_imu(reading(random, -0.2 + 0.01 * i, 0.0));
    }
    for (int scan = 0; scan < static_cast<int>(10.0 * seconds); ++scan) {
      const double t = 0.1 * scan;
      for (int i = 1; i <= 10; ++i) {
        const double at = t + 0.01 * i;
        if (imu) odometry.add_imu(reading(random, at, yaw_rate(t)));
        if (wheels && i % 2 == 0) odometry.add_wheel(at, speed(t) + 0.02 * random.normal());
      }
      const double curvature = speed(t) == 0.0 ? 0.0 : yaw_rate(t) / speed(t);
      const Pose2 begin = true_pose;
      const auto moving = [&](double offset) {
        return pose3(advance(begin, curvature, speed(t) * offset));
      };
      last = odometry.add_scan(world.scan(moving, config.lidar, t, random));
      true_pose = advance(begin, curvature, speed(t) * 0.1);
      at_end_ = advance(begin, curvature, speed(t) * (last.time_s - t));
      driven += std::abs(speed(t)) * 0.1;
    }
  }
  double error() const {
    const Eigen::Vector3d p = last.T_odom_base.translation();
    return (p.head<2>() - at_end_.position()).norm();
  }
  double yaw_error() const {
    return std::abs(
        wrap_angle(std::atan2(last.T_odom_base(1, 0), last.T_odom_base(0, 0)) - at_end_.yaw));
  }

 private:
  ImuReading reading(RandomStream& random, double t, double turn) const {
    ImuReading reading{t, {0.0, 0.0, turn}, {0.0, 0.0, 9.81}};
    const double arm = config.imu.x_m;
    reading.specific_force += Eigen::Vector3d{-turn * turn * arm, turn * speed(t), 0.0};
    for (int i = 0; i < 3; ++i) {
      reading.angular_rate(i) += 0.002 + 0.003 * random.normal();
      reading.specific_force(i) += 0.03 + 0.03 * random.normal();
    }
    return reading;
  }
  Pose2 at_end_;
};

TEST(LidarOdometry, DerivativesOfTheMotionAgreeWithDifferences) {
  Filter::State state;
  state.R = internal::rotation_by({0.1, -0.2, 0.7});
  state.v = {1.0, 0.2, -0.1};
  state.bg = {0.01, -0.02, 0.03};
  state.ba = {0.1, 0.2, -0.1};
  state.g = internal::rotation_by({0.05, 0.02, 0.0}) * state.g;
  for (const bool inertial : {true, false}) {
    std::optional<ImuReading> reading;
    if (inertial) reading = ImuReading{0.0, {0.3, -0.1, 0.5}, {0.5, 0.3, 9.9}};
    Filter::Matrix by_error;
    const Filter::State after = Filter::moved_on(state, reading, 0.02, by_error);
    Eigen::Matrix<double, 3, Filter::kSize> by_velocity;
    const Eigen::Vector3d arm{0.3, -0.1, -0.5};
    const Eigen::Vector3d turn{0.1, 0.0, 0.4};
    Filter::velocity_at(state, arm, turn, by_velocity);
    for (int i = 0; i < Filter::kSize; ++i) {
      Filter::Matrix unused;
      Eigen::Matrix<double, 3, Filter::kSize> unused_velocity;
      const Filter::Vector step = 1e-5 * Filter::Vector::Unit(i);
      const Filter::State more = state.plus(step);
      const Filter::State less = state.plus(-step);
      const Filter::Vector difference =
          (Filter::moved_on(more, reading, 0.02, unused).minus(after) -
           Filter::moved_on(less, reading, 0.02, unused).minus(after)) /
          2e-5;
      EXPECT_LT((difference - by_error.col(i)).norm(), 2e-5) << i;
      const Eigen::Vector3d velocity = (Filter::velocity_at(more, arm, turn, unused_velocity) -
                                        Filter::velocity_at(less, arm, turn, unused_velocity)) /
                                       2e-5;
      EXPECT_LT((velocity - by_velocity.col(i)).norm(), 1e-8) << i;
    }
  }
}

TEST(LidarOdometry, FollowsARowOfTrunks) {
  const RayWorld world = testing::orchard_of_trunks(60.0, 2.0, 1);
  Drive drive(world);
  drive.run();
  EXPECT_EQ(drive.last.status, OdometryStatus::kGood);
  EXPECT_LT(drive.error(), 0.1);
  EXPECT_LT(drive.yaw_error(), deg_to_rad(0.2));
}

TEST(LidarOdometry, FollowsACurveWithoutInertialUnitAndWheels) {
  const RayWorld world = testing::orchard_of_trunks(60.0, 2.0, 2);
  Drive drive(world);
  drive.imu = drive.wheels = false;
  drive.yaw_rate = [](double t) { return t > 3.0 && t < 6.0 ? 0.3 : 0.0; };
  drive.run();
  EXPECT_LT(drive.error(), 0.25);
  EXPECT_LT(drive.yaw_error(), deg_to_rad(0.5));
}

TEST(LidarOdometry, AnUpsideDownLidarGivesTheSameMotion) {
  const RayWorld world = testing::orchard_of_trunks(60.0, 2.0, 3);
  Drive drive(world);
  drive.config.lidar.roll_deg = 180.0;
  drive.config.lidar.yaw_deg = 30.0;
  drive.seconds = 4.0;
  drive.run();
  EXPECT_LT(drive.error(), 0.03);
}

TEST(LidarOdometry, BetweenWallsTheWayAlongIsLeftToTheWheels) {
  RayWorld world;
  world.walls = {{Eigen::Vector3d::UnitY(), 2.0}, {Eigen::Vector3d::UnitY(), -2.0}};
  Drive drive(world);
  drive.seconds = 5.0;
  drive.run();
  EXPECT_EQ(drive.last.status, OdometryStatus::kWeak);
  EXPECT_EQ(drive.last.weak_directions, 1);
  EXPECT_GT(std::abs(drive.last.directions(0, 0)), 0.99);
  EXPECT_LT(drive.error(), 0.1);
  EXPECT_GT(drive.last.motion.covariance(0, 0), 0.5);
  EXPECT_LT(drive.last.motion.covariance(1, 1), 1e-3);
}

TEST(LidarOdometry, BadCloudsHaveAStatusAndDoNoHarm) {
  const RayWorld world = testing::orchard_of_trunks(40.0, 2.0, 4);
  RandomStream random(1, "bad");
  const auto still = [](double) { return Eigen::Isometry3d::Identity(); };
  LidarOdometry odometry(at_height(1.5));
  EXPECT_EQ(odometry.add_scan({0.0, {}}).status, OdometryStatus::kNoPoints);
  const LidarScan good = world.scan(still, at_height(1.5).lidar, 0.1, random);
  odometry.add_scan(good);
  LidarScan bad = good;
  bad.time_s = 0.3;
  for (LidarPoint& point : bad.points) point.position.setConstant(kNan);
  EXPECT_EQ(odometry.add_scan(bad).status, OdometryStatus::kNoPoints);
  LidarScan ring = good;
  ring.time_s = 0.5;
  std::erase_if(ring.points, [](const LidarPoint& point) { return point.ring != 8; });
  const OdometryStatus one_ring = odometry.add_scan(ring).status;
  EXPECT_TRUE(one_ring == OdometryStatus::kNoPoints || one_ring == OdometryStatus::kWeak);
  bad.time_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(odometry.add_scan(bad).status, OdometryStatus::kInvalid);
  EXPECT_EQ(odometry.add_scan(good).status, OdometryStatus::kTimeBackwards);
  odometry.add_imu({0.6, {kNan, 0.0, 0.0}, {0.0, 0.0, 9.8}});
  odometry.add_wheel(0.6, std::numeric_limits<double>::infinity());
  LidarScan again = good;
  again.time_s = 0.7;
  const OdometryEstimate& estimate = odometry.add_scan(again);
  EXPECT_LT(estimate.T_odom_base.translation().norm(), 0.05);
  EXPECT_TRUE(estimate.motion.covariance.allFinite());
}

TEST(LidarOdometry, IsDeterministic) {
  const RayWorld world = testing::orchard_of_trunks(40.0, 2.0, 5);
  Drive first(world);
  first.seconds = 1.0;
  Drive second = first;
  first.run();
  second.run();
  EXPECT_EQ(first.last.T_odom_base.matrix(), second.last.T_odom_base.matrix());
}

std::vector<LidarPoint> load_ply(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::size_t count = 0;
  for (std::string line; std::getline(in, line) && line.substr(0, 10) != "end_header";) {
    if (line.substr(0, 15) == "element vertex ") count = std::stoul(line.substr(15));
  }
  std::vector<float> values(4 * count);
  in.read(reinterpret_cast<char*>(values.data()),
          static_cast<std::streamsize>(values.size() * sizeof(float)));
  std::vector<LidarPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({{values[4 * i], values[4 * i + 1], values[4 * i + 2]}});
  }
  return points;
}

TEST(LidarOdometry, AlignsARealPairOfScans) {
  const char* given = std::getenv("HEADLAND_DATA");
  const std::filesystem::path folder =
      std::filesystem::path(given ? given : std::string(HEADLAND_SOURCE_DIR) + "/../shared/data") /
      "lidar/scan_pair";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  Eigen::Matrix4d T_target_source;
  std::ifstream reference(folder / "T_target_source.txt");
  for (int i = 0; i < 16; ++i) reference >> T_target_source(i / 4, i % 4);
  LidarOdometryConfig config;
  config.far_m = 100.0;
  config.map.radius_m = 120.0;
  config.iteration_count = 30;
  LidarOdometry odometry(config);
  odometry.add_scan({0.0, load_ply(folder / "target.ply")});
  const OdometryEstimate& estimate = odometry.add_scan({0.5, load_ply(folder / "source.ply")});
  const Eigen::Matrix4d off = T_target_source.inverse() * estimate.T_odom_base.matrix();
  const Eigen::Vector3d shift = off.topRightCorner(3, 1);
  EXPECT_LT(shift.norm(), 0.03);
  EXPECT_LT(internal::rotation_vector(off.topLeftCorner(3, 3)).norm(), deg_to_rad(0.5));
}

}  // namespace
}  // namespace headland
