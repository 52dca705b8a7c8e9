// SPDX-License-Identifier: Apache-2.0
#include "control/pure_pursuit/pure_pursuit.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kStill = 1e-3;  // slower counts as standing [m/s]
// Nearer to the end of a segment than this, its tangent there measures what remains [m].
constexpr double kTangentFrom = 0.05;
// Path::at() at a segment's end is already the next segment; this much before it is not [m].
constexpr double kBeforeEnd = 1e-9;

bool is_finite(const VehicleState& state) {
  return std::isfinite(state.pose.x) && std::isfinite(state.pose.y) &&
         std::isfinite(state.pose.yaw) && std::isfinite(state.speed) &&
         std::isfinite(state.steering);
}

}  // namespace

PurePursuit::PurePursuit(const Vehicle& vehicle, const PurePursuitConfig& config,
                         const SpeedLimitConfig& limits)
    : vehicle_(vehicle), config_(config), limits_(limits), filter_(config.filter) {}

Result<void> PurePursuit::do_start() {
  profile_.build(reference(), vehicle_.acceleration_mps2,
                 speed_zones(reference(), vehicle_, limits_), limits_.brake_ratio);
  plan_.build(reference(), profile_, vehicle_, config_.plan);
  filter_.reset();
  mode_ = reference().path.empty() ? Mode::kDone : Mode::kStanding;
  segment_ = 0;
  s_ = 0.0;
  gear_left_ = 0.0;
  changing_gear_ = false;
  has_last_ = false;
  steering_left_ = longest_steering();
  return {};
}

// The vehicle's own motion since the last tick [m, map]: mean speed along the mean heading.
Point2 PurePursuit::odometry(const VehicleState& measured, double dt) const {
  if (!has_last_) return {0.0, 0.0};
  const double yaw = last_.pose.yaw + 0.5 * wrap_angle(measured.pose.yaw - last_.pose.yaw);
  const double distance = 0.5 * (measured.speed + last_.speed) * dt;
  return distance * Point2(std::cos(yaw), std::sin(yaw));
}

// To the end of the segment [m]: near it, the signed distance along its tangent, which goes through
// zero however far the vehicle passes beside the end.
double PurePursuit::remaining(const Pose2& pose, double s) const {
  const PathSegment& now = segment();
  if (s < now.end_s - kTangentFrom) return now.end_s - s;
  const PathSample end = reference().path.at(now.end_s - kBeforeEnd);
  return sign(now.gear) * (end.pose.position() - pose.position()).dot(end.pose.heading());
}

// Where the plan has the vehicle for progress s [m]; past the segment's end straight on.
Pose2 PurePursuit::planned_pose(double s) const {
  const PathSegment& now = segment();
  const double inside = std::clamp(s, now.begin_s, now.end_s - kBeforeEnd);
  const PlannedSteering planned = plan_.at(reference().path, inside, segment_);
  Pose2 pose = reference().path.at(inside).pose;
  const Point2 place = pose.position() + planned.lateral * pose.left();
  pose = {place.x(), place.y(), pose.yaw + planned.heading};
  return advance(pose, 0.0, sign(now.gear) * std::max(0.0, s - inside));
}

// Curvature of the steering whose arc leads to the target: 2 y / d^2 (Coulter 1992), which holds
// in both gears.
double PurePursuit::pursuit(const Pose2& pose, const Point2& target) const {
  const Point2 p = inverse(pose) * target;
  // Not nearer than a share of the lookahead: a target beside the vehicle is no place to go.
  const double least = 0.5 * config_.lookahead_m;
  return 2.0 * p.y() / std::max(p.squaredNorm(), least * least);
}

// The command that brings the wheels to `wanted` [rad] at the end of this tick in spite of their
// lag, if rate and limit allow it.
double PurePursuit::command_angle(double wanted, double actual, double dt) const {
  const double limit = vehicle_.max_steering_rad();
  const double inside = std::clamp(wanted, -limit, limit);
  if (vehicle_.steering_lag_s <= 0.0) return inside;
  const double most = vehicle_.steering_rate_radps * dt;
  const double share = 1.0 - std::exp(-dt / vehicle_.steering_lag_s);
  return std::clamp(actual + std::clamp(inside - actual, -most, most) / share, -limit, limit);
}

// The angle that the plan wants at the progress [rad].
double PurePursuit::planned_angle() const {
  const double limit = vehicle_.max_steering_rad();
  const double curvature = plan_.at(reference().path, s_, segment_).curvature;
  return std::clamp(std::atan(vehicle_.wheelbase_m * curvature), -limit, limit);
}

// Long enough for the wheels to turn from lock to lock, so that stuck wheels cannot hold it up.
double PurePursuit::longest_steering() const {
  return 2.0 * vehicle_.max_steering_rad() / vehicle_.steering_rate_radps +
         10.0 * vehicle_.steering_lag_s + 0.5;
}

TrackOutput PurePursuit::stop(const VehicleState& measured, TrackStatus status) const {
  return {{0.0, measured.steering, 0.0}, status, s_};
}

// Stands until the vehicle is still, the gear is in and the wheels have turned.
TrackOutput PurePursuit::stand(const VehicleState& measured, double dt) {
  const bool still = std::abs(measured.speed) <= kStill;
  if (still) {
    gear_left_ -= dt;
    steering_left_ -= dt;
  }
  const TrackStatus status = changing_gear_ ? TrackStatus::kGearChange : TrackStatus::kTracking;
  // Still rolling: the wheels stay as they are.
  const double angle = still ? planned_angle() : measured.steering;
  return {{0.0, command_angle(angle, measured.steering, dt), 0.0}, status, s_};
}

TrackOutput PurePursuit::arrive(const VehicleState& measured) {
  if (segment_ + 1 == static_cast<int>(reference().path.segments().size())) {
    const bool still = std::abs(measured.speed) <= kStill;
    mode_ = still ? Mode::kDone : Mode::kStopping;
    return stop(measured, still ? TrackStatus::kDone : TrackStatus::kTracking);
  }
  ++segment_;
  s_ = segment().begin_s;
  mode_ = Mode::kStanding;
  changing_gear_ = true;
  gear_left_ = vehicle_.gear_change_s;
  steering_left_ = longest_steering();
  return stop(measured, TrackStatus::kGearChange);
}

TrackOutput PurePursuit::drive(const VehicleState& measured, const Pose2& pose, double dt) {
  const PathSegment& now = segment();
  const Path& path = reference().path;
  const auto inside = [&now](double s) { return std::clamp(s, now.begin_s, now.end_s); };
  const Projection nearest =
      path.project(pose.position(), inside(s_ - config_.search_m), inside(s_ + config_.search_m));
  if (!(nearest.distance <= config_.lost_beyond_m)) return stop(measured, TrackStatus::kPathLost);
  const double left = remaining(pose, nearest.s);
  if (left <= config_.stop_tolerance_m) return arrive(measured);
  s_ = std::clamp(nearest.s, s_, now.end_s - kBeforeEnd);

  const double most = vehicle_.acceleration_mps2 * dt;
  const double direction = sign(now.gear);
  const double v = std::max(0.0, direction * measured.speed);
  const double wanted = profile_.limit(now.end_s - left, segment_, dt);
  const double speed = std::max(0.0, std::clamp(wanted, v - most, v + most));

  // Where the vehicle will be in the middle of the cycle that this command acts on.
  const double ahead = v * config_.dead_time_s + 0.5 * (v + speed) * 0.5 * dt;
  const double s = nearest.s + ahead;
  const double driven = std::tan(measured.steering) / vehicle_.wheelbase_m;
  const Pose2 then = advance(pose, driven, direction * ahead);
  const double seconds = config_.lookahead_time_s +
                         deg_to_rad(config_.lookahead_turn_deg) / vehicle_.steering_rate_radps;
  const double lookahead = config_.lookahead_m + seconds * v;
  const Point2 target = planned_pose(s + lookahead).position();
  const double feedback = pursuit(then, target) - pursuit(planned_pose(s), target);
  const double curvature = plan_.at(path, inside(s), segment_).curvature + feedback;
  const double angle = std::atan(vehicle_.wheelbase_m * curvature);
  return {{direction * speed, command_angle(angle, measured.steering, dt), 0.0},
          TrackStatus::kTracking,
          s_};
}

TrackOutput PurePursuit::do_step(const VehicleEstimate& estimate, double dt) {
  const VehicleState& measured = estimate.state;
  // And keep it from the filter.
  if (!is_finite(measured) || !(dt > 0.0)) return {{}, TrackStatus::kBadState, s_};
  filter_.update(odometry(measured, dt), measured.pose.position());
  last_ = measured;
  has_last_ = true;
  const Point2 place = filter_.position();
  const Pose2 pose{place.x(), place.y(), measured.pose.yaw + filter_.heading_error()};
  if (mode_ == Mode::kDone) return stop(measured, TrackStatus::kDone);
  if (mode_ == Mode::kStopping) return arrive(measured);
  if (mode_ == Mode::kStanding) {
    const bool rolling = std::abs(measured.speed) > kStill;
    const bool turned =
        std::abs(planned_angle() - measured.steering) <= deg_to_rad(config_.steering_tolerance_deg);
    const bool in_gear = gear_left_ <= 0.0 && (turned || steering_left_ <= 0.0);
    // A start while driving goes on driving.
    const bool moving_start = !changing_gear_ && rolling;
    if (!moving_start && (rolling || !in_gear)) return stand(measured, dt);
    mode_ = Mode::kDriving;
    changing_gear_ = false;
  }
  return drive(measured, pose, dt);
}

}  // namespace headland
