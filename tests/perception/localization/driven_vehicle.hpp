// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/random.hpp"
#include "perception/localization/global_filter.hpp"
#include "perception/localization/local_filter.hpp"

namespace headland::testing {

/// A vehicle that drives up and down rows of 130 m, 4 m apart, at 1 m/s: true pose, and sensors
/// with their errors. Ticks of 10 ms.
class DrivenVehicle {
 public:
  explicit DrivenVehicle(std::uint64_t seed) : random_(seed, "driven_vehicle") {}

  static constexpr double kTick = 0.01;
  static constexpr double kRow = 130.0;
  static constexpr double kTurnRadius = 2.0;
  static constexpr double kTurnUp = 1.0;  // [rad/s2]
  double wheel_scale = 0.02;
  double gyro_bias = 0.003;
  double wheel_noise = 0.02;
  double gyro_noise = 0.004;

  void step() {
    const double in_cycle = std::fmod(driven_, kRow + kPi * kTurnRadius);
    const int cycle = static_cast<int>(driven_ / (kRow + kPi * kTurnRadius));
    const double wanted =
        in_cycle < kRow ? 0.0 : (cycle % 2 == 0 ? 1.0 : -1.0) * speed_ / kTurnRadius;
    yaw_rate_ += std::clamp(wanted - yaw_rate_, -kTurnUp * kTick, kTurnUp * kTick);
    pose_ = advance(pose_, yaw_rate_ / speed_, speed_ * kTick);
    driven_ += speed_ * kTick;
    ++tick_;
  }
  double time() const { return tick_ * kTick; }
  bool every(double period) const {
    return tick_ % static_cast<int>(std::lround(period / kTick)) == 0;
  }
  const Pose2& pose() const { return pose_; }
  double driven() const { return driven_; }

  double wheel() { return speed_ * (1.0 + wheel_scale) + wheel_noise * random_.normal(); }
  double gyro() { return yaw_rate_ + gyro_bias + gyro_noise * random_.normal(); }
  Measurement fix(double deviation, FixQuality quality = FixQuality::kFixed) {
    Measurement fix{time(), MeasurementKind::kPosition, {}, deviation, quality};
    fix.value = {pose_.x + deviation * random_.normal(), pose_.y + deviation * random_.normal()};
    return fix;
  }
  Measurement heading(double deviation) {
    return {time(),
            MeasurementKind::kHeading,
            {pose_.yaw + deviation * random_.normal(), 0.0},
            deviation};
  }
  /// The motion since the last call of this, as a lidar odometry tells it.
  MotionIncrement scan_motion() {
    constexpr double kPosition = 0.003;  // [m]
    constexpr double kYaw = 0.0003;      // [rad]
    Pose2 moved = inverse(scan_pose_) * pose_;
    moved.x += kPosition * random_.normal();
    moved.y += kPosition * random_.normal();
    moved.yaw += kYaw * random_.normal();
    const Eigen::Vector3d deviation{kPosition, kPosition, kYaw};
    const MotionIncrement motion{scan_s_, time(), moved, deviation.cwiseAbs2().asDiagonal()};
    scan_pose_ = pose_;
    scan_s_ = time();
    return motion;
  }
  RandomStream& random() { return random_; }

 private:
  RandomStream random_;
  Pose2 pose_{3.0, 2.0, 0.4};
  double speed_ = 1.0;
  double yaw_rate_ = 0.0;
  double driven_ = 0.0;
  int tick_ = 0;
  Pose2 scan_pose_ = pose_;
  double scan_s_ = 0.0;
};

/// Both filters fed by a vehicle: wheels at 50 Hz, gyroscope at 100 Hz, increments at 20 Hz,
/// with `scans` the motions of a lidar odometry at 10 Hz.
struct DrivenFilters {
  LocalFilter local{LocalFilterConfig{}};
  GlobalFilter global;
  bool scans = false;
  explicit DrivenFilters(const GlobalFilterConfig& config = {}) : global(config) {}

  void tick(DrivenVehicle& vehicle) {
    vehicle.step();
    local.add_yaw_rate(vehicle.time(), vehicle.gyro(), vehicle.gyro_noise);
    if (vehicle.every(0.02)) local.add_speed(vehicle.time(), vehicle.wheel(), vehicle.wheel_noise);
    if (scans && vehicle.every(0.1)) local.add_scan_motion(vehicle.scan_motion());
    if (vehicle.every(0.05)) global.add_increment(local.take_increment(vehicle.time()));
  }
  double error(const DrivenVehicle& vehicle) const {
    return (global.estimate().pose.position() - vehicle.pose().position()).norm();
  }
};

inline Eigen::Matrix3d start_covariance() {
  return Eigen::Vector3d{0.01, 0.01, 0.001}.asDiagonal();
}

}  // namespace headland::testing
