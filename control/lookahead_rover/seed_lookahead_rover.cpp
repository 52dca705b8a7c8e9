// SPDX-License-Identifier: Apache-2.0
#include "control/lookahead_rover/seed_lookahead_rover.hpp"

#include <cmath>
#include <utility>

#include "core/base/error.hpp"

namespace headland {

std::optional<double> last_circle_crossing(const Point2& center, double radius, const Point2& p1,
                                           const Point2& p2) {
  // |p1 + u (p2 - p1) - center|^2 = radius^2, a quadratic in u.
  const Point2 along = p2 - p1;
  const Point2 from_center = p1 - center;
  const double a = along.squaredNorm();
  const double half_b = from_center.dot(along);
  const double c = from_center.squaredNorm() - radius * radius;
  const double discriminant = half_b * half_b - a * c;
  if (a == 0.0 || discriminant < 0.0) return std::nullopt;  // Fig. 10a
  const double root = std::sqrt(discriminant);
  for (const double u : {(-half_b + root) / a, (-half_b - root) / a}) {  // Fig. 10d: farther first
    if (u >= 0.0 && u <= 1.0) return u;
  }
  return std::nullopt;  // Fig. 10b
}

SeedLookaheadRover::SeedLookaheadRover(const SeedLookaheadConfig& config,
                                       std::vector<Point2> waypoints)
    : config_(config), waypoints_(std::move(waypoints)) {
  HEADLAND_CHECK(waypoints_.size() >= 2, "a path needs at least two waypoints");
}

void SeedLookaheadRover::advance_index(const Point2& p) {
  const int last = static_cast<int>(waypoints_.size()) - 1;
  while (current_ < last && (waypoints_[static_cast<std::size_t>(current_ + 1)] - p).norm() <
                                config_.crossed_within_m) {
    ++current_;
  }
}

std::optional<Point2> SeedLookaheadRover::local_goal(const Point2& p) const {
  // Of several valid points the one on the first segment counts, so that no part of the path is
  // cut off (Fig. 11).
  for (std::size_t i = static_cast<std::size_t>(current_); i + 1 < waypoints_.size(); ++i) {
    const Point2& p1 = waypoints_[i];
    const Point2& p2 = waypoints_[i + 1];
    if (const auto u = last_circle_crossing(p, config_.lookahead_m, p1, p2)) {
      return Point2(p1 + *u * (p2 - p1));
    }
  }
  return std::nullopt;
}

SeedLookaheadStep SeedLookaheadRover::step(const Pose2& measured, double cycle) {
  SeedLookaheadStep out;
  const Point2 p = measured.position();
  advance_index(p);
  if (current_ + 1 == static_cast<int>(waypoints_.size())) {
    out.goal = waypoints_.back();
    out.done = true;
    return out;
  }
  const auto goal = local_goal(p);
  out.goal_found = goal.has_value();
  out.goal = goal ? *goal : waypoints_[static_cast<std::size_t>(current_)];
  const double phi = std::atan2(out.goal.y() - p.y(), out.goal.x() - p.x());
  out.steering = wrap_angle(phi - measured.yaw);  // (004) Eq. 5
  if (std::abs(out.steering) < deg_to_rad(config_.steering_threshold_deg)) out.steering = 0.0;
  out.yaw_rate = out.steering / cycle;                                           // (004) Eq. 6
  out.speed = config_.speed_mps * (1.0 - std::abs(out.steering) / (2.0 * kPi));  // (004) Eq. 7
  return out;
}

Pose2 turn_then_move(const Pose2& pose, double speed, double yaw_rate, double cycle) {
  const double yaw = wrap_angle(pose.yaw + yaw_rate * cycle);
  return {pose.x + speed * cycle * std::cos(yaw), pose.y + speed * cycle * std::sin(yaw), yaw};
}

}  // namespace headland
