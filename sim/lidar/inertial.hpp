// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "core/base/random.hpp"
#include "core/world/lidar.hpp"

namespace headland {

/// Errors of an inertial unit; the defaults are those of an industrial MEMS unit at 100 Hz. Biases
/// start at random and walk.
struct InertialConfig {
  double gyro_noise_radps = 0.0017;
  double gyro_bias_radps = 0.003;
  double gyro_walk_radps = 2e-5;
  double force_noise_mps2 = 0.015;
  double force_bias_mps2 = 0.03;
  double force_walk_mps2 = 2e-4;

  template <class V>
  void visit(V& v) {
    v("gyro_noise_radps", gyro_noise_radps, config::kNonNegative,
      "Standard deviation of a reading's white noise, each axis [rad/s]");
    v("gyro_bias_radps", gyro_bias_radps, config::kNonNegative,
      "Standard deviation of the first bias, each axis [rad/s]");
    v("gyro_walk_radps", gyro_walk_radps, config::kNonNegative,
      "Standard deviation of the bias's change in a second [rad/s]");
    v("force_noise_mps2", force_noise_mps2, config::kNonNegative,
      "Standard deviation of a reading's white noise, each axis [m/s2]");
    v("force_bias_mps2", force_bias_mps2, config::kNonNegative,
      "Standard deviation of the first bias, each axis [m/s2]");
    v("force_walk_mps2", force_walk_mps2, config::kNonNegative,
      "Standard deviation of the bias's change in a second [m/s2]");
  }
};

/// Gyroscopes and accelerometers of a vehicle, from its true poses: rates and accelerations are
/// second-order differences of three poses in a row, at the unit's own place. Poses every 5 to 20
/// ms do well. Deterministic for a seed. Does not allocate.
class InertialSimulator {
 public:
  InertialSimulator(const InertialConfig& config, const SensorMount& mount, std::uint64_t seed);

  /// Takes the pose that is true at `time` [s]; returns the reading of the pose before it, with
  /// that one's time, or nullopt until three poses are there. A pose that is not finite or not
  /// later than the last one starts anew.
  std::optional<ImuReading> sense(const Eigen::Isometry3d& T_map_base, double time);

  const Eigen::Vector3d& gyro_bias() const { return gyro_bias_; }    ///< now [rad/s]
  const Eigen::Vector3d& force_bias() const { return force_bias_; }  ///< now [m/s2]

 private:
  struct Sample {
    double time = 0.0;
    Eigen::Isometry3d T_map_imu = Eigen::Isometry3d::Identity();
  };
  Eigen::Vector3d noise(double deviation);

  InertialConfig config_;
  Eigen::Isometry3d T_base_imu_;
  RandomStream random_;
  Eigen::Vector3d gyro_bias_;
  Eigen::Vector3d force_bias_;
  std::array<Sample, 3> samples_{};  // the latest last
  int count_ = 0;
};

}  // namespace headland
