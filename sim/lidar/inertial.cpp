// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/inertial.hpp"

#include <cmath>

#include "core/model/energy.hpp"

namespace headland {

InertialSimulator::InertialSimulator(const InertialConfig& config, const SensorMount& mount,
                                     std::uint64_t seed)
    : config_(config),
      T_base_imu_(mount.pose()),
      random_(seed, "sim/inertial"),
      gyro_bias_(noise(config.gyro_bias_radps)),
      force_bias_(noise(config.force_bias_mps2)) {}

std::optional<ImuReading> InertialSimulator::sense(const Eigen::Isometry3d& T_map_base,
                                                   double time) {
  const bool sound = T_map_base.matrix().allFinite() && std::isfinite(time);
  if (!sound || (count_ > 0 && !(time > samples_[2].time))) count_ = 0;
  if (!sound) return std::nullopt;
  samples_[0] = samples_[1];
  samples_[1] = samples_[2];
  samples_[2] = {time, T_map_base * T_base_imu_};
  if (++count_ < 3) return std::nullopt;
  count_ = 3;

  const auto& [first, middle, last] = samples_;
  const double before = middle.time - first.time;
  const double after = last.time - middle.time;
  const Eigen::Matrix3d R_imu_map = middle.T_map_imu.linear().transpose();
  const Eigen::Matrix3d turn = first.T_map_imu.linear().transpose() * last.T_map_imu.linear();
  const Eigen::AngleAxisd angle(turn);
  // The axis is the same in the first and in the last frame; a turn that bends takes it to between.
  const Eigen::Vector3d rate =
      R_imu_map * first.T_map_imu.linear() * angle.axis() * (angle.angle() / (before + after));
  const Eigen::Vector3d velocity_before =
      (middle.T_map_imu.translation() - first.T_map_imu.translation()) / before;
  const Eigen::Vector3d velocity_after =
      (last.T_map_imu.translation() - middle.T_map_imu.translation()) / after;
  const Eigen::Vector3d acceleration = 2.0 * (velocity_after - velocity_before) / (before + after);

  gyro_bias_ += noise(config_.gyro_walk_radps * std::sqrt(after));
  force_bias_ += noise(config_.force_walk_mps2 * std::sqrt(after));
  ImuReading reading;
  reading.time_s = middle.time;
  reading.angular_rate = rate + gyro_bias_ + noise(config_.gyro_noise_radps);
  reading.specific_force = R_imu_map * (acceleration + Eigen::Vector3d(0.0, 0.0, kGravity)) +
                           force_bias_ + noise(config_.force_noise_mps2);
  return reading;
}

Eigen::Vector3d InertialSimulator::noise(double deviation) {
  const double x = random_.normal();
  const double y = random_.normal();
  const double z = random_.normal();
  return deviation * Eigen::Vector3d(x, y, z);
}

}  // namespace headland
