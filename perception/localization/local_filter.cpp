// SPDX-License-Identifier: Apache-2.0
#include "perception/localization/local_filter.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "perception/localization/internal/kalman.hpp"

namespace headland {
namespace {

// Where what lies in the state. kSpeed is the speed as the wheels read it, so that the filter
// learns nothing about their scale but from scans; the true one is (1 - scale) times it. The pose
// is in the frame of the last increment's end, and so is the pose at the end of the last scan:
// neither covariance grows with the way.
enum Index { kX = 0, kYaw = 2, kSpeed, kYawRate, kBias, kScale, kSlip, kScanX };

constexpr int kKept = 1000;            // events, for late readings
constexpr double kLongestStep = 0.1;   // [s]
constexpr int kMostSteps = 100;        // of a prediction
constexpr double kSameTime = 1e-3;     // scans that end and begin within this belong together [s]
constexpr int kBelieveAgain = 5;       // rejections in a row
constexpr double kFirstSpeed = 2.0;    // [m/s]
constexpr double kFirstYawRate = 0.5;  // [rad/s]

double squared(double value) { return value * value; }

Pose2 pose_of(const Eigen::Vector3d& v) { return {v(0), v(1), v(2)}; }

// Covariance of the pose if the slow errors, the gyroscope's bias and the wheels' scale, were
// known: they are the same in all increments, and who adds those up has states of its own for them.
Eigen::Matrix3d without_slow_errors(const LocalFilter::Matrix& covariance) {
  const Eigen::Matrix<double, 3, 2> cross = covariance.block<3, 2>(kX, kBias);
  const Eigen::Matrix2d slow = covariance.block<2, 2>(kBias, kBias);
  return covariance.topLeftCorner<3, 3>() - cross * slow.inverse() * cross.transpose();
}

}  // namespace

LocalFilter::LocalFilter(const LocalFilterConfig& config)
    : config_(config), replay_(config.replay_s, kKept) {
  State first;
  first.covariance(kSpeed, kSpeed) = squared(kFirstSpeed);
  first.covariance(kYawRate, kYawRate) = squared(kFirstYawRate);
  first.covariance(kBias, kBias) = squared(config_.first_bias_radps);
  first.covariance(kScale, kScale) = squared(config_.first_scale_ratio);
  first.covariance(kSlip, kSlip) = squared(deg_to_rad(config_.side_slip_deg));
  replay_.reset(first);
}

LocalFilter::Vector LocalFilter::moved_on(const Vector& state, double dt, double side_slip_s,
                                          Matrix& by_state) {
  const double way = (1.0 - state(kScale)) * state(kSpeed) * dt;
  const double course = state(kYaw) + 0.5 * dt * state(kYawRate) + state(kSlip);
  const Eigen::Vector2d along{std::cos(course), std::sin(course)};
  const Eigen::Vector2d across{-along.y(), along.x()};
  const double kept = std::exp(-dt / side_slip_s);
  Vector after = state;
  after.segment<2>(kX) += way * along;
  after(kYaw) += dt * state(kYawRate);
  after(kSlip) *= kept;
  by_state.setIdentity();
  by_state.block<2, 1>(kX, kYaw) = way * across;
  by_state.block<2, 1>(kX, kSpeed) = (1.0 - state(kScale)) * dt * along;
  by_state.block<2, 1>(kX, kScale) = -state(kSpeed) * dt * along;
  by_state.block<2, 1>(kX, kYawRate) = 0.5 * dt * way * across;
  by_state.block<2, 1>(kX, kSlip) = way * across;
  by_state(kYaw, kYawRate) = dt;
  by_state(kSlip, kSlip) = kept;
  return after;
}

Eigen::Vector3d LocalFilter::relative(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                      Eigen::Matrix<double, 3, 6>& by_poses) {
  const double c = std::cos(from(2));
  const double s = std::sin(from(2));
  Eigen::Matrix2d turn;  // from odom to `from`
  turn << c, s, -s, c;
  const Eigen::Vector2d moved = turn * (to - from).head<2>();
  by_poses.setZero();
  by_poses.block<2, 2>(0, 0) = -turn;
  by_poses.block<2, 1>(0, 2) << moved.y(), -moved.x();
  by_poses.block<2, 2>(0, 3) = turn;
  by_poses(2, 2) = -1.0;
  by_poses(2, 5) = 1.0;
  return {moved.x(), moved.y(), to(2) - from(2)};
}

void LocalFilter::predict(State& state, double time_s) const {
  if (!(state.time_s < time_s)) {
    if (std::isnan(state.time_s)) state.time_s = time_s;
    return;
  }
  const double total = time_s - state.time_s;
  const int steps = std::clamp(static_cast<int>(std::ceil(total / kLongestStep)), 1, kMostSteps);
  const double dt = total / steps;
  Matrix by_state;
  for (int i = 0; i < steps; ++i) {
    const double way = std::abs(state.mean(kSpeed)) * dt;
    state.mean = moved_on(state.mean, dt, config_.side_slip_s, by_state);
    state.covariance = (by_state * state.covariance * by_state.transpose()).eval();
    auto variance = state.covariance.diagonal();
    variance.segment<2>(kX).array() += squared(config_.position_drift_m) * way;
    variance(kSpeed) += squared(config_.speed_walk_mps) * dt;
    variance(kYawRate) += squared(config_.yaw_rate_walk_radps) * dt;
    variance(kBias) += squared(config_.bias_walk_radps) * dt;
    variance(kScale) += squared(config_.scale_walk_ratio) * dt;
    variance(kSlip) += squared(deg_to_rad(config_.side_slip_deg)) *
                       (1.0 - std::exp(-2.0 * dt / config_.side_slip_s));
  }
  state.time_s = time_s;
}

ReadingOutcome LocalFilter::apply_number(State& state, const Event& event) const {
  internal::Innovation<kSize, 1> seen;
  seen.by_state.setZero();
  const int measured = event.kind == EventKind::kSpeed ? kSpeed : kYawRate;
  double expected = state.mean(measured);
  seen.by_state(measured) = 1.0;
  if (event.kind == EventKind::kYawRate) {
    expected += state.mean(kBias);
    seen.by_state(kBias) = 1.0;
  }
  seen.residual(0) = event.value - expected;
  seen.noise(0) = squared(event.deviation);
  int& rejected = state.rejected[static_cast<int>(event.kind)];
  ReadingOutcome outcome = ReadingOutcome::kUsed;
  if (seen.squared_distance(state.covariance) > internal::gate_99(1)) {
    if (++rejected < kBelieveAgain) return ReadingOutcome::kRejected;
    state.covariance(measured, measured) += squared(seen.residual(0));
    outcome = ReadingOutcome::kReanchored;
  }
  rejected = 0;
  internal::update<kSize, 1>(state.mean, state.covariance, seen);
  if (event.kind == EventKind::kSpeed) state.motion_s = event.time_s;
  return outcome;
}

ReadingOutcome LocalFilter::apply_scan(State& state, const Event& event) const {
  ReadingOutcome outcome = ReadingOutcome::kWaiting;
  if (std::abs(state.scan_s - event.motion.begin_s) < kSameTime) {
    Eigen::Matrix<double, 3, 6> by_poses;
    const Eigen::Vector3d expected =
        relative(state.mean.segment<3>(kScanX), state.mean.segment<3>(kX), by_poses);
    internal::Innovation<kSize, 3> seen;
    seen.residual << event.motion.moved.x - expected(0), event.motion.moved.y - expected(1),
        wrap_angle(event.motion.moved.yaw - expected(2));
    seen.by_state.setZero();
    seen.by_state.middleCols<3>(kScanX) = by_poses.leftCols<3>();
    seen.by_state.middleCols<3>(kX) = by_poses.rightCols<3>();
    seen.noise = event.motion.covariance;
    int& rejected = state.rejected[static_cast<int>(event.kind)];
    outcome = ReadingOutcome::kUsed;
    if (seen.squared_distance(state.covariance) > internal::gate_99(3)) {
      outcome = ReadingOutcome::kRejected;
      if (++rejected >= kBelieveAgain) {
        state.covariance.diagonal().segment<3>(kX) += seen.residual.cwiseAbs2();
        outcome = ReadingOutcome::kReanchored;
      }
    }
    if (outcome != ReadingOutcome::kRejected) {
      rejected = 0;
      internal::update<kSize, 3>(state.mean, state.covariance, seen);
      state.motion_s = event.time_s;
    }
  }
  // The pose at the end of this scan is cloned: the next motion begins there.
  state.mean.segment<3>(kScanX) = state.mean.segment<3>(kX);
  state.covariance.middleRows<3>(kScanX) = state.covariance.middleRows<3>(kX).eval();
  state.covariance.middleCols<3>(kScanX) = state.covariance.middleCols<3>(kX).eval();
  state.scan_s = event.time_s;
  return outcome;
}

// What moved since the last increment becomes the next one, and the frame of the poses moves on to
// its end: the pose is zero there without doubt, the last scan's pose is related to it.
void LocalFilter::apply_take(State& state) const {
  state.taken.end_s = state.time_s;
  state.taken.moved = pose_of(state.mean.segment<3>(kX));
  state.taken.covariance = without_slow_errors(state.covariance);
  state.origin = state.origin * state.taken.moved;
  Eigen::Matrix<double, 3, 6> by_poses;
  const Eigen::Vector3d scan =
      relative(state.mean.segment<3>(kX), state.mean.segment<3>(kScanX), by_poses);
  Matrix by_state = Matrix::Identity();
  by_state.topLeftCorner<3, 3>().setZero();
  by_state.block<3, 3>(kScanX, kX) = by_poses.leftCols<3>();
  by_state.block<3, 3>(kScanX, kScanX) = by_poses.rightCols<3>();
  state.mean.segment<3>(kX).setZero();
  state.mean.segment<3>(kScanX) = scan;
  state.covariance = (by_state * state.covariance * by_state.transpose()).eval();
}

ReadingOutcome LocalFilter::apply(State& state, const Event& event) const {
  predict(state, event.time_s);
  switch (event.kind) {
    case EventKind::kSpeed:
    case EventKind::kYawRate:
    case EventKind::kWheelYawRate:
      return apply_number(state, event);
    case EventKind::kScan:
      return apply_scan(state, event);
    case EventKind::kTake:
      apply_take(state);
      break;
  }
  return ReadingOutcome::kUsed;
}

ReadingOutcome LocalFilter::add(const Event& event) {
  const auto outcome =
      replay_.add(event, [this](State& state, const Event& e) { return apply(state, e); });
  return outcome.value_or(ReadingOutcome::kTooOld);
}

ReadingOutcome LocalFilter::add_speed(double time_s, double speed, double deviation) {
  if (!std::isfinite(time_s + speed + deviation)) return ReadingOutcome::kInvalid;
  return add(
      {time_s, EventKind::kSpeed, speed, std::max(deviation, config_.least_speed_noise_mps), {}});
}

ReadingOutcome LocalFilter::add_yaw_rate(double time_s, double yaw_rate, double deviation) {
  if (!std::isfinite(time_s + yaw_rate + deviation)) return ReadingOutcome::kInvalid;
  return add({time_s,
              EventKind::kYawRate,
              yaw_rate,
              std::max(deviation, config_.least_yaw_rate_noise_radps),
              {}});
}

ReadingOutcome LocalFilter::add_wheel_yaw_rate(double time_s, double yaw_rate, double deviation) {
  if (!std::isfinite(time_s + yaw_rate + deviation)) return ReadingOutcome::kInvalid;
  return add({time_s,
              EventKind::kWheelYawRate,
              yaw_rate,
              std::max(deviation, config_.least_yaw_rate_noise_radps),
              {}});
}

ReadingOutcome LocalFilter::add_scan_motion(const MotionIncrement& motion) {
  const bool usable = std::isfinite(motion.begin_s) && motion.end_s > motion.begin_s &&
                      std::isfinite(motion.moved.x + motion.moved.y + motion.moved.yaw) &&
                      motion.covariance.allFinite() &&
                      motion.covariance.diagonal().minCoeff() > 0.0;
  if (!usable) return ReadingOutcome::kInvalid;
  return add({motion.end_s, EventKind::kScan, 0.0, 0.0, motion});
}

MotionIncrement LocalFilter::take_increment(double now_s) {
  MotionIncrement increment;
  if (std::isnan(handed_out_s_) && std::isfinite(now_s)) handed_out_s_ = now_s;
  increment.begin_s = increment.end_s = handed_out_s_;
  if (!(now_s >= handed_out_s_) || !replay_.reaches(now_s)) return increment;
  add({now_s, EventKind::kTake, 0.0, 0.0, {}});
  const State& state = replay_.state();
  increment.end_s = now_s;
  increment.moved = inverse(handed_out_) * state.origin;
  increment.moved.yaw = state.origin.yaw - handed_out_.yaw;
  increment.covariance = state.taken.covariance;
  handed_out_ = state.origin;
  handed_out_s_ = now_s;
  return increment;
}

LocalEstimate LocalFilter::estimate() const {
  const State& state = replay_.state();
  LocalEstimate estimate;
  estimate.time_s = state.time_s;
  estimate.pose = state.origin * pose_of(state.mean.segment<3>(kX));
  estimate.speed = (1.0 - state.mean(kScale)) * state.mean(kSpeed);
  estimate.yaw_rate = state.mean(kYawRate);
  estimate.gyro_bias = state.mean(kBias);
  estimate.wheel_scale = state.mean(kScale);
  estimate.side_slip = state.mean(kSlip);
  estimate.speed_deviation = std::sqrt(std::max(0.0, state.covariance(kSpeed, kSpeed)));
  estimate.last_motion_s = state.motion_s;
  return estimate;
}

}  // namespace headland
