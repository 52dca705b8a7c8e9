// SPDX-License-Identifier: Apache-2.0
#include "perception/localization/localizer.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kIncrement = 0.05;  // from the local to the global filter at least so often [s]
constexpr double kOdometrySilence = 1.0;  // after that there is no odometry [s]
constexpr double kSteepest = 1.4;         // steering angle [rad]

}  // namespace

Localizer::Localizer(const LocalizerConfig& config)
    : config_(config),
      R_base_imu_(config.odometry.imu.pose().linear()),
      odometry_(config.odometry),
      local_(config.local),
      global_(config.global) {}

void Localizer::start(double time_s, const Pose2& T_map_base, const Eigen::Matrix3d& covariance) {
  global_.start(time_s, T_map_base, covariance);
}

// Motion up to now goes from the local to the global filter.
void Localizer::hand_on(double now_s) {
  const MotionIncrement increment = local_.take_increment(now_s);
  if (increment.end_s > increment.begin_s) global_.add_increment(increment);
  handed_on_s_ = std::max(handed_on_s_, now_s);
}

ReadingOutcome Localizer::add(const Measurement& reading) {
  if (!std::isfinite(reading.time)) return ReadingOutcome::kInvalid;
  ReadingOutcome outcome = ReadingOutcome::kInvalid;
  switch (reading.kind) {
    case MeasurementKind::kPosition:
    case MeasurementKind::kHeading:
      if (reading.time > handed_on_s_) hand_on(reading.time);
      return global_.add(reading);
    case MeasurementKind::kSpeed:
      odometry_.add_wheel(reading.time, reading.value[0]);
      outcome = local_.add_speed(reading.time, reading.value[0], reading.deviation);
      break;
    case MeasurementKind::kYawRate:
      outcome = local_.add_yaw_rate(reading.time, reading.value[0], reading.deviation);
      break;
    case MeasurementKind::kTurn: {
      double yaw_rate = reading.value[0];
      if (config_.wheelbase_m > 0.0) {
        const double steering = std::clamp(reading.value[0], -kSteepest, kSteepest);
        yaw_rate = local_.estimate().speed * std::tan(steering) / config_.wheelbase_m;
      }
      outcome = local_.add_wheel_yaw_rate(reading.time, yaw_rate,
                                          std::max(reading.deviation, config_.turn_noise_radps));
      break;
    }
  }
  if (reading.time > handed_on_s_ + kIncrement) hand_on(reading.time);
  return outcome;
}

ReadingOutcome Localizer::add(const ImuReading& reading) {
  odometry_.add_imu(reading);
  const double yaw_rate = (R_base_imu_ * reading.angular_rate).z();
  const ReadingOutcome outcome =
      local_.add_yaw_rate(reading.time_s, yaw_rate, config_.gyro_noise_radps);
  const bool due = reading.time_s > handed_on_s_ + kIncrement;
  if (due && outcome != ReadingOutcome::kInvalid) hand_on(reading.time_s);
  return outcome;
}

ReadingOutcome Localizer::add(const LidarScan& scan) {
  const OdometryEstimate& seen = odometry_.add_scan(scan);
  const bool used = seen.status == OdometryStatus::kGood || seen.status == OdometryStatus::kWeak ||
                    seen.status == OdometryStatus::kFirst;
  if (!used) return ReadingOutcome::kRejected;
  MotionIncrement motion = seen.motion;
  if (seen.status == OdometryStatus::kFirst) motion.begin_s = scan.time_s - 1.0;  // joins no other
  return local_.add_scan_motion(motion);
}

const PoseEstimate& Localizer::estimate(double now_s) {
  if (!std::isfinite(now_s) || now_s < estimate_.time_s) return estimate_;
  hand_on(now_s);
  const GlobalEstimate global = global_.estimate();
  const LocalEstimate local = local_.estimate();
  estimate_.time_s = now_s;
  estimate_.pose = global.pose;
  estimate_.covariance = global.covariance;
  estimate_.speed_mps = (1.0 + global.odometry_scale) * local.speed * std::cos(local.side_slip);
  estimate_.yaw_rate_radps = local.yaw_rate - global.odometry_turning;
  estimate_.health = global.health;
  const bool moved_lately = now_s - local.last_motion_s < kOdometrySilence;  // false for NaN
  if (estimate_.health.state == PoseState::kGood && !moved_lately) {
    estimate_.health = {PoseState::kCoasting, PoseReason::kNoOdometry};
  }
  return estimate_;
}

}  // namespace headland
