// SPDX-License-Identifier: Apache-2.0
#include "local_planner/course.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kSearch = 1.5;      // the nearest point of the path is sought so far ahead [m]
constexpr double kNearPlace = 20.0;  // the place is sought so far from the progress [m]
constexpr double kAtStop = 0.1;      // a cusp is reached this near [m]
constexpr double kStill = 0.05;      // slower counts as standing [m/s]
constexpr double kBeforeEnd = 1e-9;  // Path::at() at a segment's end is already the next one [m]
constexpr double kBrakeShare = 0.7;  // of the vehicle's braking, before stops
constexpr double kCreep = 0.1;       // the last centimetres to a stop [m/s]
constexpr double kPivotRate = 0.6;   // [rad/s]
constexpr double kPivotFrom = 1.0;   // an aim farther aside than this is turned to first [rad]

// Whether a curve of `radius` from here never meets the aim (in `base`): it lies inside that
// turning circle.
bool inside_turn(const Point2& aim, double radius) {
  return radius > 0.0 && (aim - Point2(0.0, std::copysign(radius, aim.y()))).norm() < radius;
}

}  // namespace

Course::Course(const LocalGoal& goal)
    : goal_(goal), path_(goal.path != nullptr && !goal.path->empty() ? goal.path : nullptr) {
  if (path_ == nullptr) return;
  s_ = std::clamp(goal.s, 0.0, path_->length());
  const auto& segments = path_->segments();
  while (segment_ + 1 < segments.size() && s_ >= segments[segment_].end_s) ++segment_;
  const Projection place =
      path_->project(goal.place, std::max(0.0, s_ - kNearPlace), s_ + kNearPlace);
  if (place.distance < std::max(goal.accuracy_m, 0.1)) place_s_ = place.s;
}

bool Course::steers_for_place(const Point2& position, double lateral, double lookahead) {
  if ((goal_.place - position).norm() <= goal_.accuracy_m) reached_ = true;
  if (reached_ || place_s_ < 0.0 || place_s_ > s_ + lookahead) return false;
  return place_s_ < s_ || std::abs(lateral) > 0.5 * goal_.accuracy_m;
}

Aim Course::from(const VehicleState& state, double lookahead) {
  const Point2 position = state.pose.position();
  const double to_place = (goal_.place - position).norm();
  if (path_ == nullptr) return {goal_.place, Gear::kForward, to_place, goal_.accuracy_m};
  const auto& segments = path_->segments();
  const auto to_end = [&](const PathSegment& segment) {
    if (s_ < segment.end_s - kAtStop) return segment.end_s - s_;
    const Pose2 end = path_->at(segment.end_s - kBeforeEnd).pose;
    return sign(segment.gear) * (end.position() - position).dot(end.heading());
  };
  const Projection nearest =
      path_->project(position, s_, std::min(s_ + kSearch, segments[segment_].end_s));
  s_ = nearest.s;
  double left = to_end(segments[segment_]);
  if (segment_ + 1 < segments.size() && left < kAtStop && std::abs(state.speed) < kStill) {
    s_ = segments[segment_].end_s;
    left = to_end(segments[++segment_]);
  }
  const PathSegment& segment = segments[segment_];
  if (steers_for_place(position, nearest.distance, lookahead)) {
    return {goal_.place, segment.gear, std::max(left, to_place), goal_.accuracy_m};
  }
  const double s = std::min(s_ + lookahead, segment.end_s - kBeforeEnd);
  const Pose2 ahead = path_->at(s).pose;
  const double beyond = s_ + lookahead - s;
  return {ahead.position() + sign(segment.gear) * beyond * ahead.heading(), segment.gear, left};
}

Motion pursue(const Vehicle& vehicle, const VehicleState& state, const Aim& aim, double speed) {
  const Point2 p = inverse(state.pose) * aim.point;
  const double most = tightest_curvature(vehicle);
  const double stop =
      std::sqrt(2.0 * kBrakeShare * vehicle.acceleration_mps2 * std::max(0.0, aim.left));
  const double wanted = aim.left > 0.02 ? std::min(speed, std::max(kCreep, stop)) : 0.0;
  const double off = std::atan2(sign(aim.gear) * p.y(), sign(aim.gear) * p.x());
  if (vehicle.steering == Steering::kDifferential && std::abs(off) > kPivotFrom) {
    return {0.0, 0.0, wanted > 0.0 ? std::copysign(kPivotRate, off) : 0.0};
  }
  Gear gear = aim.gear;
  double curvature = std::clamp(2.0 * p.y() / std::max(1e-6, p.squaredNorm()), -most, most);
  if (std::abs(off) > 0.5 * kPi) curvature = std::copysign(most, p.y());  // turns round first
  if (vehicle.steering == Steering::kAckermann && inside_turn(p, 1.0 / most - 0.5 * aim.accuracy)) {
    curvature = 0.0;
    if (vehicle.can_reverse && sign(gear) * p.x() > 0.0) {
      gear = gear == Gear::kForward ? Gear::kReverse : Gear::kForward;
    }
  }
  return {sign(gear) * speed_within(vehicle, wanted, gear, curvature), curvature, 0.0};
}

}  // namespace headland
