// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/inertial.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/model/energy.hpp"
#include "sim/lidar/scene.hpp"

namespace headland {
namespace {

constexpr double kTick = 0.01;

InertialConfig exact() { return {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}; }

Eigen::Isometry3d at(double x, double y, double yaw) {
  return Eigen::Translation3d(x, y, 0.0) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
}

template <class Motion>
std::vector<ImuReading> readings(InertialSimulator& imu, const Motion& motion, int ticks) {
  std::vector<ImuReading> all;
  for (int i = 0; i < ticks; ++i) {
    if (const auto reading = imu.sense(motion(i * kTick), i * kTick)) all.push_back(*reading);
  }
  return all;
}

TEST(Inertial, AtRestItFeelsItsWeightAlone) {
  InertialSimulator imu(exact(), {}, 1);
  const auto all = readings(
      imu, [](double) { return at(3.0, 4.0, 1.0); }, 10);
  ASSERT_EQ(all.size(), 8u);
  for (const ImuReading& reading : all) {
    EXPECT_LT(reading.angular_rate.norm(), 1e-9);
    EXPECT_LT((reading.specific_force - Eigen::Vector3d(0.0, 0.0, kGravity)).norm(), 1e-9);
  }
  EXPECT_NEAR(all.front().time_s, kTick, 1e-12);
}

TEST(Inertial, OnACircleItFeelsTheTurnAndThePullInwards) {
  // 2 m/s on a radius of 4 m to the left.
  InertialSimulator imu(exact(), {}, 1);
  const auto circle = [](double t) {
    return at(4.0 * std::sin(0.5 * t), 4.0 - 4.0 * std::cos(0.5 * t), 0.5 * t);
  };
  for (const ImuReading& reading : readings(imu, circle, 100)) {
    EXPECT_LT((reading.angular_rate - Eigen::Vector3d(0.0, 0.0, 0.5)).norm(), 1e-9);
    EXPECT_LT((reading.specific_force - Eigen::Vector3d(0.0, 1.0, kGravity)).norm(), 1e-4);
  }
}

TEST(Inertial, AwayFromBaseItFeelsThatOnesTurn) {
  SensorMount mount;
  mount.x_m = 2.0;
  InertialSimulator imu(exact(), mount, 1);
  const auto spin = [](double t) { return at(0.0, 0.0, 0.8 * t); };
  for (const ImuReading& reading : readings(imu, spin, 50)) {
    EXPECT_NEAR(reading.specific_force.x(), -2.0 * 0.8 * 0.8, 1e-4);
  }
}

TEST(Inertial, SpeedingUpPushesFromBehind) {
  InertialSimulator imu(exact(), {}, 1);
  const auto faster = [](double t) { return at(0.5 * 1.5 * t * t, 0.0, 0.0); };
  for (const ImuReading& reading : readings(imu, faster, 50)) {
    EXPECT_NEAR(reading.specific_force.x(), 1.5, 1e-6);
  }
}

TEST(Inertial, OnASlopeTheWeightLeans) {
  RowLayout layout;
  layout.slope_along_deg = 10.0;
  const LidarScene scene = LidarScene::rows(layout, vineyard(false), 1);
  InertialSimulator imu(exact(), {}, 1);
  const auto stand = [&](double) { return scene.pose_on_ground({10.0, 0.0, 0.0}); };
  for (const ImuReading& reading : readings(imu, stand, 5)) {
    EXPECT_NEAR(reading.specific_force.x(), kGravity * std::sin(deg_to_rad(10.0)), 1e-3);
    EXPECT_NEAR(reading.specific_force.z(), kGravity * std::cos(deg_to_rad(10.0)), 1e-3);
  }
}

TEST(Inertial, UpsideDownItsAxesAreTurned) {
  SensorMount mount;
  mount.roll_deg = 180.0;
  InertialSimulator imu(exact(), mount, 1);
  const auto spin = [](double t) { return at(0.0, 0.0, 0.8 * t); };
  for (const ImuReading& reading : readings(imu, spin, 5)) {
    EXPECT_NEAR(reading.angular_rate.z(), -0.8, 1e-9);
    EXPECT_NEAR(reading.specific_force.z(), -kGravity, 1e-6);
  }
}

TEST(Inertial, RatesAddUpToTheTurnAboutAllAxes) {
  InertialSimulator imu(exact(), {}, 1);
  const auto sway = [](double t) {
    return Eigen::Isometry3d(Eigen::AngleAxisd(0.3 * std::sin(t), Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(0.2 * std::sin(1.3 * t), Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(0.1 * std::sin(0.7 * t), Eigen::Vector3d::UnitX()));
  };
  Eigen::Matrix3d attitude = sway(0.5 * kTick).linear();
  double end = 0.0;
  for (const ImuReading& reading : readings(imu, sway, 500)) {
    const Eigen::Vector3d turn = kTick * reading.angular_rate;
    attitude = attitude * Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    end = reading.time_s + 0.5 * kTick;
  }
  EXPECT_LT(Eigen::AngleAxisd(Eigen::Matrix3d(attitude.transpose() * sway(end).linear())).angle(),
            1e-4);
}

TEST(Inertial, NoiseAndBiasAreAsSaid) {
  InertialConfig config = exact();
  config.gyro_noise_radps = 0.01;
  config.force_noise_mps2 = 0.2;
  config.gyro_bias_radps = 0.05;
  InertialSimulator imu(config, {}, 1);
  const Eigen::Vector3d bias = imu.gyro_bias();
  EXPECT_GT(bias.norm(), 0.01);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double gyro = 0.0;
  double force = 0.0;
  const auto all = readings(
      imu, [](double) { return at(0.0, 0.0, 0.0); }, 20000);
  for (const ImuReading& reading : all) {
    sum += reading.angular_rate;
    gyro += (reading.angular_rate - bias).squaredNorm();
    force += (reading.specific_force - Eigen::Vector3d(0.0, 0.0, kGravity)).squaredNorm();
  }
  const auto count = static_cast<double>(all.size());
  EXPECT_LT((sum / count - bias).norm(), 5e-4);
  EXPECT_NEAR(std::sqrt(gyro / (3.0 * count)), 0.01, 2e-4);
  EXPECT_NEAR(std::sqrt(force / (3.0 * count)), 0.2, 4e-3);
}

TEST(Inertial, ItsBiasWalks) {
  InertialConfig config = exact();
  config.gyro_walk_radps = 0.01;
  double squares = 0.0;
  constexpr int kUnits = 200;
  for (int seed = 0; seed < kUnits; ++seed) {
    InertialSimulator imu(config, {}, static_cast<std::uint64_t>(seed));
    readings(
        imu, [](double) { return at(0.0, 0.0, 0.0); }, 402);  // 4 s
    squares += imu.gyro_bias().squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(squares / (3.0 * kUnits)), 0.02, 0.003);
}

TEST(Inertial, TimeThatRunsBackAndLostPosesStartAnew) {
  InertialSimulator imu(exact(), {}, 1);
  const Eigen::Isometry3d pose = at(0.0, 0.0, 0.0);
  Eigen::Isometry3d lost = pose;
  lost.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(imu.sense(pose, 0.00));
  EXPECT_FALSE(imu.sense(pose, 0.01));
  EXPECT_TRUE(imu.sense(pose, 0.02));
  EXPECT_FALSE(imu.sense(at(5.0, 0.0, 0.0), 0.02));  // time stands still
  EXPECT_FALSE(imu.sense(at(5.0, 0.0, 0.0), 0.03));
  const auto reading = imu.sense(at(5.0, 0.0, 0.0), 0.04);
  ASSERT_TRUE(reading);
  EXPECT_NEAR(reading->specific_force.norm(), kGravity, 1e-9);  // no jump to there
  EXPECT_FALSE(imu.sense(lost, 0.05));
  EXPECT_FALSE(imu.sense(pose, 0.06));
  EXPECT_FALSE(imu.sense(pose, 0.07));
  EXPECT_TRUE(imu.sense(pose, 0.08));
}

}  // namespace
}  // namespace headland
