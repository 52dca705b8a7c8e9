// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/internal/pose_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace headland::internal {
namespace {

constexpr std::int64_t kNumbersPerDraw = 4;
// Shares of the nodes: those around corners of the border, and where those along it begin.
constexpr double kAtCorners = 0.25;
constexpr double kAlongBorder = 0.6;
constexpr double kCornerReach = 1.5;  // [turning radii]
constexpr int kMissesOfAKind = 200;   // another kind of place then

}  // namespace

PoseSampler::PoseSampler(const Region& region, double turning_radius, std::uint64_t seed,
                         std::int64_t draws)
    : region_(region),
      reach_(kCornerReach * turning_radius),
      random_(seed, "roadmap"),
      draws_(draws) {
  for (std::int64_t i = 0; i < kNumbersPerDraw * draws; ++i) random_.uniform();
  for (const Polygon& polygon : region.polygons()) {
    corners_.insert(corners_.end(), polygon.outer.begin(), polygon.outer.end());
    for (const Polyline& hole : polygon.holes) {
      corners_.insert(corners_.end(), hole.begin(), hole.end());
    }
  }
  low_ = high_ = corners_.front();
  for (const Point2& p : corners_) {
    low_ = low_.cwiseMin(p);
    high_ = high_.cwiseMax(p);
  }
}

std::optional<Pose2> PoseSampler::draw() {
  const double kind = random_.uniform();
  const double u = random_.uniform();
  const double v = random_.uniform();
  const double yaw = random_.uniform(0.0, kPi);
  // A kind is drawn for each node, not for each draw: corners are easier to hit than roads.
  if (misses_ % kMissesOfAKind == 0) kind_ = kind;
  ++draws_;
  ++misses_;
  Point2 place = low_ + Point2(u, v).cwiseProduct(high_ - low_);
  if (kind_ < kAtCorners) {
    const auto i =
        static_cast<std::size_t>(kind_ / kAtCorners * static_cast<double>(corners_.size()));
    const double angle = 2.0 * kPi * v;
    place = corners_[i] + reach_ * std::sqrt(u) * Point2(std::cos(angle), std::sin(angle));
  }
  if (!region_.contains(place)) return std::nullopt;
  return Pose2{place.x(), place.y(), kind_ < kAlongBorder ? yaw : border_direction(place)};
}

double PoseSampler::border_direction(const Point2& p) const {
  double least = std::numeric_limits<double>::infinity();
  Point2 along(1.0, 0.0);
  const auto look = [&](const Polyline& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2& a = ring[i];
      const Point2& b = ring[(i + 1) % ring.size()];
      const double distance = distance_to_segment(p, a, b);
      if (distance >= least) continue;
      least = distance;
      along = b - a;
    }
  };
  for (const Polygon& polygon : region_.polygons()) {
    look(polygon.outer);
    std::for_each(polygon.holes.begin(), polygon.holes.end(), look);
  }
  return std::atan2(along.y(), along.x());
}

}  // namespace headland::internal
