// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/three_point.hpp"

#include "core/geometry/internal/steering.hpp"

namespace headland {
namespace {

constexpr double kSliver = 1e-9;  // [m, rad]

double angle_of(const Point2& v) { return std::atan2(v.y(), v.x()); }

}  // namespace

std::optional<Curve> three_point_turn(const Pose2& from, const Pose2& to, const SmoothTurn& turn,
                                      double hand) {
  const double radius = turn.radius();
  const Point2 first = from * Point2(radius * turn.ahead(), hand * radius * turn.aside());
  const Point2 last = to * Point2(-radius * turn.ahead(), hand * radius * turn.aside());
  const Point2 apart = last - first;
  const double distance = apart.norm();
  if (distance >= 4.0 * radius || distance < kSliver) return std::nullopt;
  const Point2 across = Point2(-apart.y(), apart.x()) / distance *
                        std::sqrt(4.0 * radius * radius - 0.25 * distance * distance);
  const auto turned = [hand](double from_yaw, double to_yaw) {
    return wrap_positive(hand * (to_yaw - from_yaw), kSliver);
  };
  const double ramp = turn.ramp() * radius;
  std::optional<Curve> best;
  for (const double side : {1.0, -1.0}) {
    const Point2 middle = 0.5 * (first + last) + side * across;
    // Headings at the cusps.
    const double out = angle_of(middle - first) + hand * 0.5 * kPi;
    const double in = angle_of(middle - last) + hand * 0.5 * kPi;
    const double begin = turned(from.yaw, out) - turn.ramp_angle();
    const double end = turned(in, to.yaw) - turn.ramp_angle();
    if (begin < 0.0 || end < 0.0) continue;
    Curve curve;
    if (turn.has_ramps()) curve.add({0.0, ramp, hand * turn.sharpness()});
    curve.add({hand / radius, radius * begin});
    curve.add({-hand / radius, -radius * turned(out, in)});
    curve.add({hand / radius, radius * end});
    if (turn.has_ramps()) curve.add({hand / radius, ramp, -hand * turn.sharpness()});
    if (!best || curve.length() < best->length()) best = curve;
  }
  return best;
}

}  // namespace headland
