// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/config/visit.hpp"
#include "core/world/lidar.hpp"
#include "perception/localization/internal/inertial_filter.hpp"
#include "perception/localization/internal/thinner.hpp"
#include "perception/localization/local_filter.hpp"
#include "perception/localization/voxel_map.hpp"

namespace headland {

struct LidarOdometryConfig {
  SensorMount lidar;
  SensorMount imu;
  VoxelMapConfig map;
  double near_m = 0.8;
  double far_m = 50.0;
  double map_cell_m = 0.1;
  double scan_cell_m = 0.25;
  int iteration_count = 8;
  double kernel_ratio = 3.0;
  double weak_count = 15.0;
  double weak_ratio = 0.03;
  double least_position_noise_m = 0.004;
  double least_rotation_noise_deg = 0.03;
  double wheel_noise_mps = 0.1;
  double side_noise_mps = 0.1;
  double gyro_noise_radps = 0.002;
  double accelerometer_noise_mps2 = 0.1;

  template <class V>
  void visit(V& v) {
    v("lidar", lidar, "Where the lidar sits");
    v("imu", imu, "Where the inertial unit sits");
    v("map", map, "The map of voxels");
    v("near_m", near_m, config::kNonNegative, "Nearer to the lidar it is the vehicle itself [m]");
    v("far_m", far_m, config::kPositive, "Points farther away are not used [m]");
    v("map_cell_m", map_cell_m, config::kPositive,
      "One point in such a cell goes into the map [m]");
    v("scan_cell_m", scan_cell_m, config::kPositive, "One point in such a cell is matched [m]");
    v("iteration_count", iteration_count, config::Range{1.0, 100.0}, "Of the update, at most");
    v("kernel_ratio", kernel_ratio, config::kPositive,
      "Residuals larger than so many deviations lose their weight (Geman-McClure)");
    v("weak_count", weak_count, config::kNonNegative,
      "A direction that fewer matched points tell of is left to wheels and inertial unit (points "
      "that face it fully)");
    v("weak_ratio", weak_ratio, config::kFraction,
      "Likewise as a share of all points matched: so many face a direction by their noise alone, "
      "which in foliage ties the scan to where it was predicted to be");
    v("least_position_noise_m", least_position_noise_m, config::kPositive,
      "No scan tells the position better: points of one surface err together [m]");
    v("least_rotation_noise_deg", least_rotation_noise_deg, config::kPositive,
      "Likewise of the rotation [deg]");
    v("wheel_noise_mps", wheel_noise_mps, config::kPositive, "Of one wheel reading [m/s]");
    v("side_noise_mps", side_noise_mps, config::kPositive,
      "Of the speed to the side and up, which wheels do not allow [m/s]");
    v("gyro_noise_radps", gyro_noise_radps, config::kPositive, "Over one second [rad]");
    v("accelerometer_noise_mps2", accelerometer_noise_mps2, config::kPositive,
      "Over one second [m/s]");
  }
};

enum class OdometryStatus : std::int8_t {
  kNone,   ///< no scan yet
  kFirst,  ///< the first scan: it begins the map
  kGood,
  kWeak,      ///< in some directions the scan says nothing: there it is wheels and inertial unit
  kNoPoints,  ///< too few points, or none that match: carried on without
  kTimeBackwards,  ///< ends before the last one did: not used
  kInvalid         ///< its time is not a number: not used
};

/// What the lidar odometry knows after a scan, at the time of the scan's last point.
struct OdometryEstimate {
  double time_s = 0.0;
  OdometryStatus status = OdometryStatus::kNone;
  Eigen::Isometry3d T_odom_base = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};  ///< in odom [m/s]
  int matched = 0;                          ///< points
  /// How many points tell of each direction, least first, and the directions in odom (columns).
  Eigen::Vector3d support{0.0, 0.0, 0.0};
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
  int weak_directions = 0;
  /// Motion in the plane since the scan before, for the local filter, if status is kGood or kWeak.
  MotionIncrement motion;
};

/// Odometry from a lidar, with or without an inertial unit and wheels.
///
/// Iterated error-state Kalman filter (after FAST-LIO2: the gain in information form, K =
/// (H'R^-1H + P^-1)^-1 H'R^-1, so that its cost grows with the state and not with the points).
/// Points are put straight by the motion within the scan, thinned, and matched to a map of voxel
/// Gaussians by the Mahalanobis distance with Geman-McClure weights. Where the scan says too little
/// about a direction, as along a row of foliage, that direction is left to the prediction, which
/// wheels and inertial unit keep. Readings may come before or after each other, but not after the
/// scan that covers them. `odom` begins at base's place at the first scan, z up. Deterministic. One
/// thread at a time. A scan of 28.8 k points takes some 10 ms.
class LidarOdometry {
 public:
  explicit LidarOdometry(const LidarOdometryConfig& config);

  void add_imu(const ImuReading& reading);
  void add_wheel(double time_s, double speed_mps);
  const OdometryEstimate& add_scan(const LidarScan& scan_in_sensor_frame);

  const OdometryEstimate& estimate() const { return estimate_; }
  const VoxelMap& map() const { return map_; }

 private:
  struct WheelReading {
    double time_s = 0.0;
    double speed_mps = 0.0;
  };
  struct Node {  // of the way within a scan
    double time_s = 0.0;
    Eigen::Vector3d p{0.0, 0.0, 0.0};
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  };
  struct Match {  // sums over the points of a scan
    Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> vector = Eigen::Matrix<double, 6, 1>::Zero();
    int points = 0;
  };

  void start(double time_s);
  void carry_on_to(double time_s);
  void advance_to(double time_s, std::optional<ImuReading> reading);
  void apply_wheel(const WheelReading& wheel);
  void straighten(const LidarScan& scan);
  Match match(const internal::InertialFilter::State& state, double kernel) const;
  void leave_weak_directions(Match& match);
  void blur(Match& match) const;
  void fit_scan();
  void extend_map();
  void report(OdometryStatus status, const Pose2& before, double before_s);
  Eigen::Isometry3d pose() const;

  LidarOdometryConfig config_;
  Eigen::Isometry3f T_body_lidar_;
  Eigen::Matrix3d R_body_imu_;
  Eigen::Vector3d base_in_body_;
  internal::InertialFilter filter_;
  VoxelMap map_;
  OdometryEstimate estimate_;
  bool started_ = false;
  double time_s_ = 0.0;          // of the filter's state
  std::vector<ImuReading> imu_;  // by time, those to come; in the body's frame
  std::optional<ImuReading> last_imu_;
  std::vector<WheelReading> wheels_;  // by time, those to come
  int wheels_rejected_ = 0;           // in a row
  std::vector<Node> way_;
  std::vector<Eigen::Isometry3f> straight_;  // T_end_then of each slice of the scan's time
  std::vector<Eigen::Vector3f> points_;      // in the body at the scan's end
  std::vector<Eigen::Vector3f> map_points_;
  std::vector<Eigen::Vector3f> scan_points_;
  internal::Thinner thinner_;
  Eigen::Matrix<double, 6, 6> scan_information_ = Eigen::Matrix<double, 6, 6>::Zero();
};

}  // namespace headland
