// SPDX-License-Identifier: Apache-2.0
#include "control/pure_pursuit/seed_pure_pursuit.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// First of the nearest points with index in [first, last].
int nearest(const std::vector<Point2>& points, const Point2& p, int first, int last) {
  int best = first;
  double least = kInfinity;
  for (int i = first; i <= last; ++i) {
    const double distance = (points[static_cast<std::size_t>(i)] - p).norm();
    if (distance < least) {
      least = distance;
      best = i;
    }
  }
  return best;
}

}  // namespace

int SeedRoute::last_point(int of_link) const {
  return static_cast<int>(std::upper_bound(link.begin(), link.end(), of_link) - link.begin()) - 1;
}

const Point2& SeedRoute::goal(int index, double lookahead) const {
  auto at = static_cast<std::size_t>(index);
  const auto last = static_cast<std::size_t>(last_point(link[at]));
  for (double s = 0.0; at < last && s < lookahead; ++at) s += (points[at + 1] - points[at]).norm();
  return points[at];
}

double seed_steering(const Point2& goal, const Pose2& T_map_base, double lookahead,
                     double wheelbase) {
  const double y = (goal - T_map_base.position()).dot(T_map_base.left());
  return std::atan(wheelbase * 2.0 * y / (lookahead * lookahead));
}

SeedPurePursuit::SeedPurePursuit(const SeedPurePursuitConfig& config, const SeedRoute& route)
    : config_(config), route_(route), limit_(deg_to_rad(config.max_steering_deg)) {}

double SeedPurePursuit::saturate(double steering) const {
  return std::clamp(steering, -limit_, limit_);
}

SeedPurePursuit::Output SeedPurePursuit::step(const Pose2& T_map_base) {
  return config_.segment_bounded ? step_bounded(T_map_base) : step_plain(T_map_base);
}

SeedPurePursuit::Output SeedPurePursuit::step_bounded(const Pose2& T_map_base) {
  const Point2 p = T_map_base.position();
  const int last_link = route_.links() - 1;
  // 1. Nearest waypoint of the present link and the next few; never one already passed.
  const int horizon = route_.last_point(std::min(link_ + config_.links_ahead, last_link));
  index_ = nearest(route_.points, p, index_, horizon);
  const int found = route_.link[static_cast<std::size_t>(index_)];
  if (found != link_) {
    link_ = found;
    guided_before_ = next_before_ = kInfinity;
  }
  // 2. Guided-point override: both distances grow, and the present one is large. The authors' code
  // has a second override on the last link whose condition no steering angle meets.
  const Point2& guided = route_.guided[static_cast<std::size_t>(link_)];
  const Point2& next = route_.guided[static_cast<std::size_t>(std::min(link_ + 1, last_link))];
  const double to_guided = (p - guided).norm();
  const double to_next = (p - next).norm();
  const bool leaving = to_guided > guided_before_ && to_next > next_before_;
  guided_before_ = to_guided;
  next_before_ = to_next;
  if (leaving && to_guided > config_.override_beyond_m && link_ < last_link) {
    const double bearing = std::atan2(guided.y() - p.y(), guided.x() - p.x());
    return {saturate(wrap_angle(bearing - T_map_base.yaw)), link_, true};
  }
  // 3. Pure pursuit on the present link; the first and last link count as lines.
  const bool turn =
      route_.is_turn[static_cast<std::size_t>(link_)] && link_ != 0 && link_ != last_link;
  const double lookahead = turn ? config_.lookahead_turn_m : config_.lookahead_line_m;
  const Point2& goal = route_.goal(index_, lookahead);
  return {saturate(seed_steering(goal, T_map_base, lookahead, config_.wheelbase_m)), link_, false};
}

// The first waypoint after the globally nearest one that is at least the lookahead away: what the
// seed calls row peeking happens here.
SeedPurePursuit::Output SeedPurePursuit::step_plain(const Pose2& T_map_base) const {
  const Point2 p = T_map_base.position();
  const int last = static_cast<int>(route_.points.size()) - 1;
  auto goal = static_cast<std::size_t>(nearest(route_.points, p, 0, last));
  const int link = route_.link[goal];
  while (static_cast<int>(goal) < last &&
         (p - route_.points[goal]).norm() < config_.lookahead_line_m) {
    ++goal;
  }
  const double lookahead = config_.lookahead_line_m;
  return {saturate(seed_steering(route_.points[goal], T_map_base, lookahead, config_.wheelbase_m)),
          link, false};
}

}  // namespace headland
