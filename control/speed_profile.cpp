// SPDX-License-Identifier: Apache-2.0
#include "control/speed_profile.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

double leg_speed(const Reference& reference, int leg) {
  const auto i = static_cast<std::size_t>(std::max(leg, 0));
  return i < reference.leg_speed.size() ? reference.leg_speed[i] : 0.0;
}

// The speed which, held for one cycle and then braked, is down to `target` after `distance`.
double braking_speed(double distance, double target, double deceleration, double dt) {
  if (distance <= 0.0) return target;
  const double lead = deceleration * dt;
  return std::sqrt(lead * lead + target * target + 2.0 * deceleration * distance) - lead;
}

}  // namespace

// The knots of one piece: its begin, and the borders of zones inside it.
void SpeedProfile::add_piece(double begin_s, double end_s, double speed, int segment,
                             std::span<const SpeedZone> zones) {
  for (double s = begin_s; s < end_s;) {
    double next = end_s;
    double allowed = speed;
    for (const SpeedZone& zone : zones) {
      if (zone.begin_s >= end_s) break;
      if (zone.begin_s > s) {
        next = std::min(next, zone.begin_s);
      } else if (zone.end_s > s) {
        next = std::min(next, zone.end_s);
        allowed = std::min(allowed, zone.speed);
      }
    }
    knots_.push_back({s, allowed, allowed, segment});
    s = next;
  }
}

void SpeedProfile::build(const Reference& reference, double deceleration,
                         std::span<const SpeedZone> zones) {
  deceleration_ = deceleration;
  knots_.clear();
  const auto& segments = reference.path.segments();
  double s = 0.0;
  std::size_t segment = 0;
  for (const PathPiece& piece : reference.path.pieces()) {
    if (segment + 1 < segments.size() && s >= segments[segment].end_s - 1e-9) {
      knots_.push_back({s, 0.0, 0.0, static_cast<int>(segment)});
      ++segment;
    }
    while (!zones.empty() && zones.front().end_s <= s) zones = zones.subspan(1);
    const double speed = leg_speed(reference, piece.leg);
    add_piece(s, s + piece.length, speed, static_cast<int>(segment), zones);
    s += piece.length;
  }
  knots_.push_back({s, 0.0, 0.0, static_cast<int>(segment)});
  brake_in_time();
}

void SpeedProfile::brake_in_time() {
  // Passing from one stretch to the next, the slower of the two counts.
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    if (knots_[i].segment == knots_[i - 1].segment) {
      knots_[i].speed = std::min(knots_[i].speed, knots_[i - 1].after);
    }
  }
  // Backwards: every knot is passed slowly enough to brake for the next.
  for (std::size_t i = knots_.size() - 1; i-- > 0;) {
    const Knot& next = knots_[i + 1];
    if (next.segment != knots_[i].segment) continue;
    const double v2 = next.speed * next.speed + 2.0 * deceleration_ * (next.s - knots_[i].s);
    knots_[i].speed = std::min(knots_[i].speed, std::sqrt(v2));
  }
}

double SpeedProfile::limit(double s, int segment, double dt) const {
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), s,
                                      [](double at, const Knot& knot) { return at < knot.s; });
  // The leg under way: the last knot of this segment at or before s (or its first, when s lags).
  auto knot = after == knots_.begin() ? after : after - 1;
  while (knot != knots_.begin() && knot->segment > segment) --knot;
  while (knot != knots_.end() && knot->segment < segment) ++knot;
  if (knot == knots_.end()) return 0.0;
  const auto next = knot + 1;
  if (knot->after == 0.0 || next == knots_.end() || next->segment != segment) return 0.0;
  return std::clamp(braking_speed(next->s - s, next->speed, deceleration_, dt), 0.0, knot->after);
}

}  // namespace headland
