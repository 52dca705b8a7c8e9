// SPDX-License-Identifier: Apache-2.0
#include "control/pure_pursuit/pure_pursuit.hpp"

#include <algorithm>
#include <cmath>

#include "control/drivable.hpp"

namespace headland {
namespace {

constexpr double kStill = 1e-3;  // slower counts as standing [m/s]

}  // namespace

PurePursuit::PurePursuit(const Vehicle& vehicle, const PurePursuitConfig& config,
                         const SpeedLimitConfig& limits)
    : vehicle_(vehicle),
      config_(config),
      limits_(limits),
      filter_(config.filter),
      ramp_(vehicle.acceleration_mps2) {}

Result<void> PurePursuit::do_start() {
  profile_.build(reference(), vehicle_.acceleration_mps2,
                 speed_zones(reference(), vehicle_, limits_), limits_.brake_ratio);
  plan_.build(reference(), profile_, vehicle_, config_.plan);
  filter_.reset();
  mode_ = reference().path.empty() ? Mode::kDone : Mode::kStanding;
  progress_.start(reference().path);
  gear_left_ = 0.0;
  changing_gear_ = false;
  has_last_ = false;
  ramp_.reset();
  steering_left_ = longest_steering(vehicle_);
  return {};
}

// The vehicle's own motion since the last tick [m, map]: mean speed along the mean heading.
Point2 PurePursuit::odometry(const VehicleState& measured, double dt) const {
  if (!has_last_) return {0.0, 0.0};
  const double yaw = last_.pose.yaw + 0.5 * wrap_angle(measured.pose.yaw - last_.pose.yaw);
  const double distance = 0.5 * (measured.speed + last_.speed) * dt;
  return distance * Point2(std::cos(yaw), std::sin(yaw));
}

// Where the plan has the vehicle for progress s [m]; past the segment's end straight on.
Pose2 PurePursuit::planned_pose(double s) const {
  const PathSegment& now = progress_.segment();
  const double inside = std::clamp(s, now.begin_s, now.end_s - PathProgress::kBeforeEnd);
  const PlannedSteering planned = plan_.at(reference().path, inside, progress_.number());
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
  const double curvature = plan_.at(reference().path, progress_.s(), progress_.number()).curvature;
  return std::clamp(std::atan(vehicle_.wheelbase_m * curvature), -limit, limit);
}

TrackOutput PurePursuit::stop(const VehicleState& measured, TrackStatus status) const {
  return {{0.0, measured.steering, 0.0}, status, progress_.s()};
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
  return {{0.0, command_angle(angle, measured.steering, dt), 0.0}, status, progress_.s()};
}

TrackOutput PurePursuit::arrive(const VehicleState& measured) {
  if (progress_.on_last()) {
    const bool still = std::abs(measured.speed) <= kStill;
    mode_ = still ? Mode::kDone : Mode::kStopping;
    return stop(measured, still ? TrackStatus::kDone : TrackStatus::kTracking);
  }
  progress_.next_segment();
  ramp_.reset();
  mode_ = Mode::kStanding;
  changing_gear_ = true;
  gear_left_ = vehicle_.gear_change_s;
  steering_left_ = longest_steering(vehicle_);
  return stop(measured, TrackStatus::kGearChange);
}

TrackOutput PurePursuit::drive(const VehicleState& measured, const Pose2& pose, double dt) {
  const PathSegment& now = progress_.segment();
  const Path& path = reference().path;
  const Projection nearest = progress_.nearest(pose.position(), config_.search_m);
  if (!(nearest.distance <= config_.lost_beyond_m)) return stop(measured, TrackStatus::kPathLost);
  const double left = progress_.remaining(pose, nearest.s);
  if (left <= config_.stop_tolerance_m) return arrive(measured);
  progress_.move_to(nearest.s);

  const double direction = sign(now.gear);
  const double v = std::max(0.0, direction * measured.speed);
  const double wanted = profile_.limit(now.end_s - left, progress_.number(), dt);
  const auto [low, high] = ramp_.reach(v, dt);
  const double speed = std::max(0.0, std::clamp(wanted, low, high));
  ramp_.tell(speed);

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
  const double curvature =
      plan_.at(path, progress_.inside(s), progress_.number()).curvature + feedback;
  const double angle = std::atan(vehicle_.wheelbase_m * curvature);
  const double told = command_through_lag(speed, v, vehicle_.speed_lag_s, dt);
  return {{direction * told, command_angle(angle, measured.steering, dt), 0.0},
          TrackStatus::kTracking,
          progress_.s()};
}

TrackOutput PurePursuit::do_step(const VehicleEstimate& estimate, double dt) {
  const VehicleState& measured = estimate.state;
  // And keep it from the filter.
  if (!is_finite(measured) || !(dt > 0.0)) return {{}, TrackStatus::kBadState, progress_.s()};
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
