// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <Eigen/Core>

#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"
#include "perception/localization/health.hpp"
#include "perception/localization/internal/replay.hpp"

namespace headland {

/// How motion and sensors of the local filter wander.
struct LocalFilterConfig {
  double speed_walk_mps = 0.7;
  double yaw_rate_walk_radps = 1.0;
  double bias_walk_radps = 2e-5;
  double scale_walk_ratio = 2e-4;
  double first_bias_radps = 0.01;
  double first_scale_ratio = 0.03;
  double side_slip_deg = 2.0;
  double side_slip_s = 1.0;
  double position_drift_m = 0.002;
  double least_speed_noise_mps = 0.01;
  double least_yaw_rate_noise_radps = 0.001;
  double replay_s = 1.0;

  template <class V>
  void visit(V& v) {
    v("speed_walk_mps", speed_walk_mps, config::kPositive,
      "Standard deviation of the speed's change over one second [m/s]");
    v("yaw_rate_walk_radps", yaw_rate_walk_radps, config::kPositive, "Of the yaw rate [rad/s]");
    v("bias_walk_radps", bias_walk_radps, config::kNonNegative,
      "Of the gyroscope's bias, over one second [rad/s]");
    v("scale_walk_ratio", scale_walk_ratio, config::kNonNegative,
      "Of the wheels' scale error, over one second");
    v("first_bias_radps", first_bias_radps, config::kPositive,
      "Of the gyroscope's bias at the start [rad/s]");
    v("first_scale_ratio", first_scale_ratio, config::kPositive,
      "Of the wheels' scale error at the start");
    v("side_slip_deg", side_slip_deg, config::kPositive,
      "Of the direction of travel against the heading: wheels do not move sideways [deg]");
    v("side_slip_s", side_slip_s, config::kPositive, "Time in which a side slip dies away [s]");
    v("position_drift_m", position_drift_m, config::kNonNegative,
      "Of the position, over one metre of rough ground [m]");
    v("least_speed_noise_mps", least_speed_noise_mps, config::kPositive,
      "No wheel speed is trusted more [m/s]");
    v("least_yaw_rate_noise_radps", least_yaw_rate_noise_radps, config::kPositive,
      "No yaw rate is trusted more [rad/s]");
    v("replay_s", replay_s, config::Range{0.0, 10.0},
      "Readings as late as this are still put in their place [s]");
  }
};

/// A motion in the plane from one time to a later one: pose at the end in the frame of the begin,
/// with its covariance (x [m], y [m], yaw [rad]).
struct MotionIncrement {
  double begin_s = 0.0;
  double end_s = 0.0;
  Pose2 moved;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// What the local filter knows.
struct LocalEstimate {
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no reading yet
  Pose2 pose;                                                ///< T_odom_base
  double speed = 0.0;            ///< along the direction of travel, signed [m/s]
  double yaw_rate = 0.0;         ///< [rad/s]
  double gyro_bias = 0.0;        ///< [rad/s]
  double wheel_scale = 0.0;      ///< the speed is (1 - scale) times what wheels read
  double side_slip = 0.0;        ///< direction of travel, left of the heading [rad]
  double speed_deviation = 0.0;  ///< [m/s]
  double last_motion_s = std::numeric_limits<double>::quiet_NaN();  ///< last wheels or scan used
};

/// Short-term motion from wheels, gyroscope and lidar odometry in a frame `odom`, which drifts but
/// never jumps.
///
/// Extended Kalman filter over the pose since the last increment, speed, yaw rate, bias of the
/// gyroscope, scale error of the wheels, side slip, and the pose at the end of the last scan, to
/// which a lidar odometry's motion between two scans is related with its covariance (a cloned
/// state). That wheels do not move sideways is the side slip's pull to zero. All readings are gated
/// at 99 %; a sensor that disagrees five times in a row is believed again. Late readings are put in
/// their place. Deterministic. One thread at a time. Does not allocate after construction.
/// An update costs about 5 us.
class LocalFilter {
 public:
  explicit LocalFilter(const LocalFilterConfig& config);

  /// Wheel speed [m/s] with its standard deviation.
  ReadingOutcome add_speed(double time_s, double speed, double deviation);
  /// Yaw rate [rad/s] of a gyroscope (up axis), with its standard deviation.
  ReadingOutcome add_yaw_rate(double time_s, double yaw_rate, double deviation);
  /// Yaw rate that wheels or steering say: without the gyroscope's bias.
  ReadingOutcome add_wheel_yaw_rate(double time_s, double yaw_rate, double deviation);
  /// Motion between the ends of two scans. It is related to the scan before only where that ended
  /// when this motion begins.
  ReadingOutcome add_scan_motion(const MotionIncrement& motion);

  /// Moves on to `now_s` and gives the motion since the last call of this. Its covariance leaves
  /// out the gyroscope's bias and the wheels' scale, which are the same in all increments. Earlier
  /// than the last call: an increment of no duration.
  MotionIncrement take_increment(double now_s);

  LocalEstimate estimate() const;

  static constexpr int kSize = 11;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  /// The state after `dt` [s], and its derivatives by the state.
  static Vector moved_on(const Vector& state, double dt, double side_slip_s, Matrix& by_state);
  /// Pose `to` in the frame of `from` (both x, y, yaw), with the derivatives by from and to.
  static Eigen::Vector3d relative(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                  Eigen::Matrix<double, 3, 6>& by_poses);

 private:
  enum class EventKind { kSpeed, kYawRate, kWheelYawRate, kScan, kTake };
  struct Event {
    double time_s = 0.0;
    EventKind kind = EventKind::kSpeed;
    double value = 0.0;
    double deviation = 0.0;
    MotionIncrement motion;
  };
  struct State {
    double time_s = std::numeric_limits<double>::quiet_NaN();
    double scan_s = std::numeric_limits<double>::quiet_NaN();    // end of the last scan
    double motion_s = std::numeric_limits<double>::quiet_NaN();  // last wheels or scan used
    Pose2 origin;  // of the last increment's end, in odom
    Vector mean = Vector::Zero();
    Matrix covariance = Matrix::Zero();
    int rejected[4] = {0, 0, 0, 0};  // in a row, by kind
    MotionIncrement taken;
  };

  ReadingOutcome add(const Event& event);
  ReadingOutcome apply(State& state, const Event& event) const;
  void predict(State& state, double time_s) const;
  ReadingOutcome apply_number(State& state, const Event& event) const;
  ReadingOutcome apply_scan(State& state, const Event& event) const;
  void apply_take(State& state) const;

  LocalFilterConfig config_;
  internal::Replay<State, Event> replay_;
  Pose2 handed_out_;  // end of the increments given away, in odom
  double handed_out_s_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace headland
