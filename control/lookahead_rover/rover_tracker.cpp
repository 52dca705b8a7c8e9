// SPDX-License-Identifier: Apache-2.0
#include "control/lookahead_rover/rover_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kStanding = 1e-3;  // slower counts as standing [m/s]

}  // namespace

RoverTracker::RoverTracker(const Vehicle& vehicle, const RoverTrackerConfig& config,
                           const SpeedLimitConfig& limits)
    : vehicle_(vehicle),
      config_(config),
      limits_(limits),
      filter_(config.filter),
      ramp_(vehicle.acceleration_mps2) {}

Result<void> RoverTracker::do_start() {
  profile_.build(reference(), vehicle_.acceleration_mps2,
                 speed_zones(reference(), vehicle_, limits_), limits_.brake_ratio);
  filter_.reset();
  mode_ = reference().path.empty() ? Mode::kDone : Mode::kDriving;
  segment_ = 0;
  s_ = 0.0;
  standing_left_ = 0.0;
  has_last_ = false;
  ramp_.reset();
  return {};
}

// The vehicle's own motion since the last tick [m, map]: the exact arc of the mean speed and the
// mean heading, both brought to the middle of the cycle from their age.
Point2 RoverTracker::odometry(const VehicleState& measured, double dt) const {
  if (!has_last_ || dt <= 0.0) return {0.0, 0.0};
  const double back = (0.5 * dt - config_.motion_age_s) / dt;
  const double turn = wrap_angle(measured.pose.yaw - last_.pose.yaw);
  const double yaw = measured.pose.yaw - back * turn;
  const double distance = (measured.speed - back * (measured.speed - last_.speed)) * dt;
  return distance * Point2(std::cos(yaw), std::sin(yaw));
}

RoverTracker::Errors RoverTracker::errors(const VehicleState& measured, const Point2& position,
                                          double dt) const {
  const Path& path = reference().path;
  const PathSegment& segment = path.segments()[static_cast<std::size_t>(segment_)];
  const auto inside = [&](double s) { return std::clamp(s, segment.begin_s, segment.end_s); };
  Errors e;
  e.nearest = path.project(position, inside(s_ - config_.search_m), inside(s_ + config_.search_m));
  const double speed = std::abs(measured.speed);
  const double then = e.nearest.s - speed * config_.motion_age_s;  // where the heading belongs
  const double yaw = path.at(inside(then)).pose.yaw;
  e.heading = wrap_angle(measured.pose.yaw + filter_.heading_error() - yaw);
  // Per metre; at a standstill the path's curvature here.
  const double ahead = speed * dt;
  e.path_turn = speed > kStanding ? wrap_angle(path.at(inside(then + ahead)).pose.yaw - yaw) / ahead
                                  : sign(segment.gear) * path.at(e.nearest.s).curvature;
  // The nearest point stays at the end once the vehicle has passed it.
  e.remaining = segment.end_s - e.nearest.s;
  return e;
}

// Lateral error e and heading error psi over the driven distance s obey e' = g sin(psi) and
// psi' = (turn of the vehicle) - (turn of the path), with g the gear's sign; the feedback makes
// e'' + 2 zeta k e' + k^2 e = 0 of them, with the approach angle bounded.
Command RoverTracker::drive(const VehicleState& measured, const Errors& errors, double dt) {
  const Gear gear = reference().path.segments()[static_cast<std::size_t>(segment_)].gear;
  const double k = config_.stiffness_1pm;
  const double damping = 2.0 * config_.damping_ratio * k;
  const double steepest = deg_to_rad(config_.max_approach_deg);
  const double approach =
      -sign(gear) * std::clamp(k * k / damping * errors.nearest.lateral_error, -steepest, steepest);
  const double wanted = profile_.limit(errors.nearest.s, segment_, dt);
  const double now = std::abs(measured.speed);
  const auto [low, high] = ramp_.reach(now, dt);
  double speed = std::clamp(wanted, low, high);
  // At lateral error e the vehicle drives the path's turn on another radius.
  const double stretch = 1.0 - sign(gear) * errors.path_turn * errors.nearest.lateral_error;
  const double curvature =
      errors.path_turn / std::max(0.2, stretch) - damping * (errors.heading - approach);
  if (speed * std::abs(curvature) > config_.max_yaw_rate_radps) {
    speed = std::max(config_.max_yaw_rate_radps / std::abs(curvature), low);
  }
  ramp_.tell(speed);
  const double rate =
      std::clamp(speed * curvature, -config_.max_yaw_rate_radps, config_.max_yaw_rate_radps);
  const double told = command_through_lag(speed, now, vehicle_.speed_lag_s, dt);
  return {sign(gear) * told, 0.0, rate};
}

// Brakes, then turns on the spot: the last cycles bring the error down by a quarter each.
Command RoverTracker::pivot(const VehicleState& measured, const Errors& errors, double dt) {
  ramp_.reset();
  const double most = vehicle_.acceleration_mps2 * dt;
  const double speed = measured.speed - std::clamp(measured.speed, -most, most);
  if (std::abs(measured.speed) > kStanding) return {speed, 0.0, 0.0};
  const double rate = -0.25 * errors.heading / dt;
  return {0.0, 0.0, std::clamp(rate, -config_.max_yaw_rate_radps, config_.max_yaw_rate_radps)};
}

TrackOutput RoverTracker::do_step(const VehicleEstimate& estimate, double dt) {
  const VehicleState& measured = estimate.state;
  if (!is_finite(measured)) return stand(TrackStatus::kBadState);  // and keep it from the filter
  filter_.update(odometry(measured, dt), measured.pose.position());
  const Point2 position = filter_.position();
  last_ = measured;
  has_last_ = true;
  if (mode_ == Mode::kDone) return stand(TrackStatus::kDone);
  if (mode_ == Mode::kChangingGear) {
    standing_left_ -= dt;
    if (standing_left_ > 0.0) return stand(TrackStatus::kGearChange);
    ++segment_;
    ramp_.reset();
    mode_ = Mode::kDriving;
  }
  const Errors e = errors(measured, position, dt);
  s_ = e.nearest.s;
  if (!(e.nearest.distance <= config_.lost_beyond_m)) return stand(TrackStatus::kPathLost);
  if (e.remaining <= config_.stop_tolerance_m) {
    const bool last = segment_ + 1 == static_cast<int>(reference().path.segments().size());
    mode_ = last ? Mode::kDone : Mode::kChangingGear;
    standing_left_ = vehicle_.gear_change_s;
    return stand(last ? TrackStatus::kDone : TrackStatus::kGearChange);
  }
  const double off = std::abs(e.heading);
  if (off > deg_to_rad(config_.pivot_from_deg)) mode_ = Mode::kPivoting;
  if (off < deg_to_rad(config_.pivot_until_deg)) mode_ = Mode::kDriving;
  const Command command =
      mode_ == Mode::kPivoting ? pivot(measured, e, dt) : drive(measured, e, dt);
  return {command, TrackStatus::kTracking, s_};
}

}  // namespace headland
