// SPDX-License-Identifier: Apache-2.0
#include "perception/rows/row_tracker.hpp"

#include <cmath>

#include <Eigen/Dense>

#include "perception/rows/internal/line_motion.hpp"

namespace headland {
namespace {

constexpr double kAgreeOffset = 0.15;   // rejected fits agree with each other within this [m]
constexpr double kAgreeHeading = 0.05;  // [rad]
constexpr double kStillWalk = 0.05;     // a second at rest lets as much wander as so many metres

Eigen::Vector3d state_of(const RowEstimate& lane) {
  return {lane.offset_m, lane.heading_rad, lane.width_m};
}

void set_state(RowEstimate& lane, const Eigen::Vector3d& state) {
  lane.offset_m = state(0);
  lane.heading_rad = wrap_angle(state(1));
  lane.width_m = state(2);
  lane.left_m = lane.offset_m + 0.5 * lane.width_m;
  lane.right_m = lane.offset_m - 0.5 * lane.width_m;
}

RowEstimate lane_of(const LaneFit& fit) {
  RowEstimate lane;
  set_state(lane, {fit.offset_m, fit.heading_rad, fit.width_m});
  lane.covariance = fit.covariance;
  return lane;
}

}  // namespace

void RowTracker::reset() { *this = RowTracker(config_); }

void RowTracker::predict(const Pose2& moved, double dt_s) {
  if (!is_known_) return;
  const double way = std::hypot(moved.x, moved.y);
  const double along = internal::motion_in_row(lane_.heading_rad, moved).x();
  internal::move_lane(lane_, moved);
  internal::move_lane(rejected_, moved);
  since_fit_s_ += dt_s;
  since_fit_m_ += way;
  Eigen::Matrix3d transition = Eigen::Matrix3d::Identity();
  transition(0, 1) = along;
  Eigen::Vector3d walk(config_.offset_walk_m, deg_to_rad(config_.heading_walk_deg),
                       config_.width_walk_m);
  const double length = way + kStillWalk * dt_s;
  const Eigen::Vector3d noise = length * walk.cwiseProduct(walk);
  lane_.covariance = transition * lane_.covariance * transition.transpose();
  lane_.covariance += noise.asDiagonal();
}

void RowTracker::start(const LaneFit& fit) {
  lane_ = lane_of(fit);
  is_known_ = true;
  fits_ = 1;
  rejected_fits_ = 0;
  since_fit_s_ = 0.0;
  since_fit_m_ = 0.0;
}

RowStatus RowTracker::correct(const LaneFit& fit) {
  if (!is_known_) {
    start(fit);
    return is_valid() ? RowStatus::kValid : RowStatus::kUnconfirmed;
  }
  const RowEstimate seen = lane_of(fit);
  Eigen::Vector3d error = state_of(seen) - state_of(lane_);
  error(1) = wrap_angle(error(1));
  // The gate knows what one fit is worth, the gain that the next ones show the same plants.
  const Eigen::Matrix2d spread = (lane_.covariance + fit.covariance).topLeftCorner<2, 2>();
  const Eigen::Vector2d jump = error.head<2>();
  const double distance = jump.dot(spread.inverse() * jump);
  if (!(distance <= config_.jump_deviations_count * config_.jump_deviations_count)) {
    const bool agrees =
        std::abs(seen.offset_m - rejected_.offset_m) < kAgreeOffset &&
        std::abs(wrap_angle(seen.heading_rad - rejected_.heading_rad)) < kAgreeHeading;
    rejected_fits_ = agrees ? rejected_fits_ + 1 : 1;
    rejected_ = seen;
    if (rejected_fits_ >= config_.renew_count) start(fit);
    return RowStatus::kJump;
  }
  const Eigen::Matrix3d noise = config_.repeat_factor * fit.covariance;
  const Eigen::Matrix3d gain = lane_.covariance * (lane_.covariance + noise).inverse();
  set_state(lane_, state_of(lane_) + gain * error);
  const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() - gain;
  lane_.covariance = kept * lane_.covariance * kept.transpose() + gain * noise * gain.transpose();
  ++fits_;
  rejected_fits_ = 0;
  since_fit_s_ = 0.0;
  since_fit_m_ = 0.0;
  return is_valid() ? RowStatus::kValid : RowStatus::kUnconfirmed;
}

bool RowTracker::is_fresh() const {
  return is_known_ && since_fit_s_ <= config_.coast_s && since_fit_m_ <= config_.coast_m;
}

bool RowTracker::is_valid() const { return is_fresh() && fits_ >= config_.confirm_count; }

}  // namespace headland
