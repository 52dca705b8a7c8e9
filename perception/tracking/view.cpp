// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace headland {
namespace {

constexpr int kSamples = 9;          // over the width of a body
constexpr double kJoinRatio = 0.05;  // of the distance: arcs that begin so alike are joined

double azimuth_of(const Point2& p) { return std::atan2(p.y(), p.x()); }

}  // namespace

double SensorView::visible_share(const Point2& centre, double radius,
                                 std::span<const HiddenArc> shadows) const {
  const Point2 offset = centre - sensor;
  const double distance = offset.norm();
  if (!(distance >= near_m && distance <= far_m) || !std::isfinite(radius)) return 0.0;
  const double half = std::asin(std::clamp(radius / distance, 0.0, 1.0));
  const double azimuth = azimuth_of(offset);
  unsigned covered = 0;
  for (const HiddenArc& arc : shadows) {
    if (distance < arc.beyond_m) continue;
    const double middle = wrap_angle(azimuth - arc.begin_rad - 0.5 * arc.width_rad);
    if (std::abs(middle) > 0.5 * arc.width_rad + half) continue;
    for (int i = 0; i < kSamples; ++i) {
      const double at = middle + half * (2.0 * i / (kSamples - 1) - 1.0);
      if (std::abs(wrap_angle(at)) <= 0.5 * arc.width_rad) covered |= 1u << i;
    }
  }
  int open = 0;
  for (int i = 0; i < kSamples; ++i) open += (covered >> i & 1u) == 0;
  return static_cast<double>(open) / kSamples;
}

HiddenArc shadow_of(const Point2& sensor, const Point2& centre, double width, double behind) {
  const Point2 offset = centre - sensor;
  const double distance = offset.norm();
  const double half = std::atan2(0.5 * width, std::max(distance, 1e-3));
  return {azimuth_of(offset) - half, 2.0 * half, distance + behind};
}

void add_shadows(std::span<const Point2> points, double behind, int bins, SensorView& view) {
  if (bins < 1) return;
  constexpr double kFree = std::numeric_limits<double>::infinity();
  const double width = 2.0 * kPi / bins;
  std::vector<double> nearest(static_cast<std::size_t>(bins), kFree);
  for (const Point2& p : points) {
    const Point2 offset = p - view.sensor;
    const double distance = offset.norm();
    if (!std::isfinite(distance) || distance < view.near_m) continue;
    const int bin = static_cast<int>(wrap_positive(azimuth_of(offset)) / width);
    double& known = nearest[static_cast<std::size_t>(std::min(bin, bins - 1))];
    known = std::min(known, distance);
  }
  bool joins = false;
  for (int i = 0; i < bins; ++i) {
    const double beyond = nearest[static_cast<std::size_t>(i)] + behind;
    if (beyond == kFree) {
      joins = false;
    } else if (joins && std::abs(beyond - view.hidden.back().beyond_m) <= kJoinRatio * beyond) {
      HiddenArc& arc = view.hidden.back();
      arc.width_rad += width;
      arc.beyond_m = std::max(arc.beyond_m, beyond);
    } else {
      view.hidden.push_back({i * width, width, beyond});
      joins = true;
    }
  }
}

}  // namespace headland
