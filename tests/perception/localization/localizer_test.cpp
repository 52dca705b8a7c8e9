// SPDX-License-Identifier: Apache-2.0
#include "perception/localization/localizer.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/perception/localization/driven_vehicle.hpp"
#include "tests/perception/localization/ray_world.hpp"

namespace headland {
namespace {

using testing::DrivenVehicle;

Measurement speed_of(DrivenVehicle& vehicle) {
  return {vehicle.time(), MeasurementKind::kSpeed, {vehicle.wheel(), 0.0}, vehicle.wheel_noise};
}
Measurement yaw_rate_of(DrivenVehicle& vehicle) {
  return {vehicle.time(), MeasurementKind::kYawRate, {vehicle.gyro(), 0.0}, vehicle.gyro_noise};
}

PoseEstimate drive(Localizer& localizer, DrivenVehicle& vehicle, double metres, double latency) {
  std::vector<Measurement> under_way;
  while (vehicle.driven() < metres) {
    vehicle.step();
    localizer.add(yaw_rate_of(vehicle));
    if (vehicle.every(0.02)) localizer.add(speed_of(vehicle));
    if (vehicle.every(0.2)) under_way.push_back(vehicle.fix(0.02));
    if (vehicle.every(0.2)) under_way.push_back(vehicle.heading(deg_to_rad(0.6)));
    while (!under_way.empty() && under_way.front().time + latency <= vehicle.time()) {
      localizer.add(under_way.front());
      under_way.erase(under_way.begin());
    }
    localizer.estimate(vehicle.time());
  }
  return localizer.estimate(vehicle.time());
}

TEST(Localizer, KnowsThePoseFromItsReadings) {
  DrivenVehicle vehicle(1);
  Localizer localizer(LocalizerConfig{});
  EXPECT_EQ(localizer.estimate(0.0).health.state, PoseState::kStarting);
  const PoseEstimate estimate = drive(localizer, vehicle, 150.0, 0.0);
  EXPECT_LT((estimate.pose.position() - vehicle.pose().position()).norm(), 0.05);
  EXPECT_NEAR(wrap_angle(estimate.pose.yaw - vehicle.pose().yaw), 0.0, deg_to_rad(0.5));
  EXPECT_NEAR(estimate.speed_mps, 1.0, 0.1);
  EXPECT_EQ(estimate.health.state, PoseState::kGood);
  EXPECT_EQ(estimate.time_s, vehicle.time());
}

TEST(Localizer, LateFixesDoNotHoldItBack) {
  DrivenVehicle vehicle(2);
  Localizer localizer(LocalizerConfig{});
  const PoseEstimate estimate = drive(localizer, vehicle, 150.0, 0.4);
  EXPECT_LT((estimate.pose.position() - vehicle.pose().position()).norm(), 0.06);
}

TEST(Localizer, IsDeterministic) {
  DrivenVehicle first(3);
  DrivenVehicle second(3);
  Localizer one(LocalizerConfig{});
  Localizer two(LocalizerConfig{});
  EXPECT_EQ(drive(one, first, 20.0, 0.1).pose.x, drive(two, second, 20.0, 0.1).pose.x);
}

TEST(Localizer, ScansCarryItOnWithoutWheels) {
  const testing::RayWorld world = testing::orchard_of_trunks(40.0, 2.0, 6);
  LocalizerConfig config;
  config.odometry.lidar.z_m = 1.5;
  Localizer localizer(config);
  RandomStream random(1, "scans");
  localizer.start(0.0, {10.0, 5.0, kPi / 2.0}, testing::start_covariance());
  for (int i = 0; i < 20; ++i) localizer.add(ImuReading{-0.2 + 0.01 * i, {}, {0.0, 0.0, 9.81}});
  for (int scan = 0; scan < 50; ++scan) {
    const double t = 0.1 * scan;
    for (int i = 1; i <= 10; ++i) {
      localizer.add(ImuReading{t + 0.01 * i, {0.0, 0.0, 0.0}, {0.0, 0.0, 9.81}});
    }
    const auto moving = [&](double offset) {
      return Eigen::Isometry3d(Eigen::Translation3d(0.5 * (t + offset), 0.0, 0.0));
    };
    localizer.add(world.scan(moving, config.odometry.lidar, t, random));
    localizer.estimate(t + 0.1);
  }
  const PoseEstimate estimate = localizer.estimate(5.0);
  EXPECT_NEAR(estimate.pose.x, 10.0, 0.15);
  EXPECT_NEAR(estimate.pose.y, 7.5, 0.15);
  EXPECT_NEAR(estimate.speed_mps, 0.5, 0.1);
}

TEST(Localizer, WithoutOdometryItSaysSo) {
  Localizer localizer(LocalizerConfig{});
  localizer.start(0.0, {}, testing::start_covariance());
  localizer.add({0.5, MeasurementKind::kPosition, {0.0, 0.01}, 0.02});
  const PoseEstimate estimate = localizer.estimate(1.2);
  EXPECT_NE(estimate.health.state, PoseState::kGood);
}

TEST(Localizer, BadReadingsDoNoHarm) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  DrivenVehicle vehicle(4);
  Localizer localizer(LocalizerConfig{});
  const PoseEstimate before = drive(localizer, vehicle, 20.0, 0.0);
  EXPECT_EQ(localizer.add({nan, MeasurementKind::kSpeed, {1.0, 0.0}, 0.1}),
            ReadingOutcome::kInvalid);
  EXPECT_EQ(localizer.add(ImuReading{vehicle.time(), {0.0, 0.0, nan}, {}}),
            ReadingOutcome::kInvalid);
  EXPECT_EQ(localizer.add(LidarScan{}), ReadingOutcome::kRejected);
  EXPECT_EQ(localizer.add({1.0, MeasurementKind::kSpeed, {1.0, 0.0}, 0.1}),
            ReadingOutcome::kTooOld);
  EXPECT_EQ(localizer.estimate(nan).pose.x, before.pose.x);
  EXPECT_EQ(localizer.estimate(1.0).time_s, before.time_s);
}

}  // namespace
}  // namespace headland
