// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/ebs221/seed_fishtail.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace headland {
namespace {

// Progress from the first to the last point of the link beyond which phase 1, 2, ... is over.
constexpr std::array<double, 5> kPhaseEnds = {0.2, 0.35, 0.65, 0.8, 0.95};
// Where along its points phases 1 and 3 steer to.
constexpr double kTargetOut = 0.2;
constexpr double kTargetBack = 0.5;

int nearest_of_all(const std::vector<Point2>& points, const Point2& p) {
  const auto closer = [&p](const Point2& a, const Point2& b) {
    return (a - p).squaredNorm() < (b - p).squaredNorm();
  };
  return static_cast<int>(std::min_element(points.begin(), points.end(), closer) - points.begin());
}

double bearing(const Pose2& T_map_base, const Point2& target) {
  return wrap_angle(std::atan2(target.y() - T_map_base.y, target.x() - T_map_base.x) -
                    T_map_base.yaw);
}

}  // namespace

SeedFishtailPursuit::SeedFishtailPursuit(const SeedPurePursuitConfig& config,
                                         const SeedRoute& route, std::vector<bool> fishtails)
    : config_(config),
      route_(route),
      fishtails_(std::move(fishtails)),
      limit_(deg_to_rad(config.max_steering_deg)) {}

SeedFishtailPursuit::Output SeedFishtailPursuit::step(const Pose2& T_map_base) {
  const int index = nearest_of_all(route_.points, T_map_base.position());
  const int found = route_.link[static_cast<std::size_t>(index)];
  if (found != link_) {
    link_ = found;
    phase_ = fishtails_[static_cast<std::size_t>(link_)] ? 1 : 0;
  }
  const bool entered = phase_ > 0 && next_phase(T_map_base.position());
  const bool reverse = entered && phase_ >= 2 && phase_ <= 4;
  const double steering =
      phase_ > 0 ? phase_steering(T_map_base, reverse) : pursue(T_map_base, index);
  return {std::clamp(steering, -limit_, limit_), reverse};
}

// As SeedPurePursuit, but for the first link, which counts as a turn here.
double SeedFishtailPursuit::pursue(const Pose2& T_map_base, int index) const {
  const bool turn = route_.is_turn[static_cast<std::size_t>(link_)] && link_ != route_.links() - 1;
  const double lookahead = turn ? config_.lookahead_turn_m : config_.lookahead_line_m;
  return seed_steering(route_.goal(index, lookahead), T_map_base, lookahead, config_.wheelbase_m);
}

// At most one phase a period; true if one began.
bool SeedFishtailPursuit::next_phase(const Point2& p) {
  const Point2& first = route_.points[static_cast<std::size_t>(first_point())];
  const Point2 across = route_.points[static_cast<std::size_t>(route_.last_point(link_))] - first;
  const double progress = std::abs((p - first).dot(across)) / across.squaredNorm();
  if (progress <= kPhaseEnds[static_cast<std::size_t>(phase_ - 1)]) return false;
  phase_ = phase_ < 5 ? phase_ + 1 : 0;
  return true;
}

double SeedFishtailPursuit::phase_steering(const Pose2& T_map_base, bool reverse) const {
  const int first = first_point();
  const int last = route_.last_point(link_);
  const int count = last - first + 1;
  const auto target = [&](double part) {
    const int index = std::min(first + static_cast<int>(std::lround(part * count)), last);
    return bearing(T_map_base, route_.points[static_cast<std::size_t>(index)]);
  };
  double mean_y = 0.0;
  for (int i = first; i <= last; ++i) mean_y += route_.points[static_cast<std::size_t>(i)].y();
  mean_y /= count;
  const double out = mean_y < 0.5 * config_.wheelbase_m ? limit_ : -limit_;
  const double gear = reverse ? -1.0 : 1.0;
  switch (phase_) {
    case 1:
      return target(kTargetOut);
    case 2:
      return gear * out;
    case 3:
      return gear * target(kTargetBack);
    case 4:
      return -gear * out;
    default:
      return bearing(T_map_base, route_.points[static_cast<std::size_t>(last)]);
  }
}

}  // namespace headland
