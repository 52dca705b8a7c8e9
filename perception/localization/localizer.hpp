// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <Eigen/Core>

#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"
#include "core/model/measurement.hpp"
#include "core/world/lidar.hpp"
#include "perception/localization/global_filter.hpp"
#include "perception/localization/health.hpp"
#include "perception/localization/lidar_odometry.hpp"
#include "perception/localization/local_filter.hpp"

namespace headland {

struct LocalizerConfig {
  LidarOdometryConfig odometry;
  LocalFilterConfig local;
  GlobalFilterConfig global;
  double wheelbase_m = 0.0;
  double gyro_noise_radps = 0.005;
  double turn_noise_radps = 0.05;

  template <class V>
  void visit(V& v) {
    v("odometry", odometry, "Odometry from lidar scans");
    v("local", local, "Motion in odom");
    v("global", global, "Pose in the map");
    v("wheelbase_m", wheelbase_m, config::kNonNegative,
      "Of an Ackermann vehicle, whose turn readings are steering angles; 0: differential [m]");
    v("gyro_noise_radps", gyro_noise_radps, config::kPositive,
      "Of one yaw rate of an inertial unit [rad/s]");
    v("turn_noise_radps", turn_noise_radps, config::kPositive,
      "Of a yaw rate that wheels or steering tell: they slip [rad/s]");
  }
};

/// Where the vehicle is.
struct PoseEstimate {
  double time_s = std::numeric_limits<double>::quiet_NaN();
  Pose2 pose;              ///< T_map_base
  double speed_mps = 0.0;  ///< along the heading, signed
  double yaw_rate_radps = 0.0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y [m], yaw [rad]
  PoseHealth health;
};

/// Lidar odometry, local and global filter as one: takes every reading, gives the pose in the map.
///
/// Readings of all sensors come in the order of their arrival; late ones are put in their place
/// (see the filters), but those of inertial unit and wheels help the lidar odometry only where they
/// come before the scan that covers them. Deterministic. One thread at a time.
class Localizer {
 public:
  explicit Localizer(const LocalizerConfig& config);

  /// The pose at `time_s` is known, with its covariance (x [m], y [m], yaw [rad]).
  void start(double time_s, const Pose2& T_map_base, const Eigen::Matrix3d& covariance);

  ReadingOutcome add(const Measurement& reading);
  ReadingOutcome add(const ImuReading& reading);
  /// In the lidar's frame. The outcome is the local filter's; kRejected too where the scan has no
  /// points or its time goes backwards.
  ReadingOutcome add(const LidarScan& scan);

  /// The pose at `now_s` [s], which does not decrease; where it does, the last estimate again.
  const PoseEstimate& estimate(double now_s);

  const LidarOdometry& odometry() const { return odometry_; }

 private:
  void hand_on(double now_s);

  LocalizerConfig config_;
  Eigen::Matrix3d R_base_imu_;
  LidarOdometry odometry_;
  LocalFilter local_;
  GlobalFilter global_;
  PoseEstimate estimate_;
  double handed_on_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace headland
