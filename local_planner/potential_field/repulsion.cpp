// SPDX-License-Identifier: Apache-2.0
#include "local_planner/potential_field/repulsion.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kNearest = 0.1;  // of gaps: nearer, forces grow no more [m]

// A push away from a source, with its swirl to the side that the pull leads to.
Point2 away(const PotentialSource& source, double size, double swirl, const Point2& pull) {
  const Point2 left(-source.towards.y(), source.towards.x());
  const double side = left.dot(pull) >= 0.0 ? 1.0 : -1.0;
  return size * (swirl * side * left - source.towards);
}

}  // namespace

Point2 SeedRepulsion::push(std::span<const PotentialSource> sources, double distance, double swirl,
                           const Point2& pull) const {
  double sum = 0.0;
  Point2 force(0.0, 0.0);
  for (const PotentialSource& source : sources) {
    const double d = std::max(0.5 * kNearest, source.gap);
    if (d > reach_m) continue;
    const double sixth = std::pow(d / width_m, 6.0);
    sum += strength_ratio / (1.0 + sixth);
    const double slope = 6.0 * strength_ratio * sixth / (d * (1.0 + sixth) * (1.0 + sixth));
    force += away(source, slope, swirl, pull);
  }
  return 0.5 * distance / (1.0 + sum) * force;
}

Point2 VelocityRepulsion::push(std::span<const PotentialSource> sources, const Point2& velocity,
                               double swirl, const Point2& pull) const {
  Point2 force(0.0, 0.0);
  for (const PotentialSource& source : sources) {
    const Point2 relative = velocity - source.velocity;
    const double closing = relative.dot(source.towards);
    if (closing <= 0.0) continue;
    const double braking = 0.5 * closing * closing / acceleration_mps2;
    const double gap = std::max(kNearest, source.gap - margin_m);
    const double free = std::max(kNearest, gap - braking);
    if (free >= reach_m) continue;
    const double slope = strength_m / (free * free);
    const Point2 across = relative - closing * source.towards;
    force += away(source, slope * (1.0 + closing / acceleration_mps2), swirl, pull) +
             slope * closing / (acceleration_mps2 * gap) * across;
  }
  return force;
}

}  // namespace headland
