// SPDX-License-Identifier: Apache-2.0
#include "control/speed_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr double kEver = std::numeric_limits<double>::infinity();  // [s]
constexpr double kSame = 1e-9;  // nearer to the braking curve than this is on it [m]

}  // namespace

// The knots of one piece: its begin, and the borders of zones inside it.
void SpeedProfile::add_piece(double begin_s, double end_s, double speed, int segment,
                             std::span<const SpeedZone> zones) {
  for (double s = begin_s; s < end_s;) {
    while (!zones.empty() && zones.front().end_s <= s) zones = zones.subspan(1);
    double next = end_s;
    double allowed = speed;
    for (const SpeedZone& zone : zones) {
      if (zone.begin_s >= next) break;
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

void SpeedProfile::build(const Reference& reference, double acceleration,
                         std::span<const SpeedZone> zones, double brake_ratio) {
  acceleration_ = acceleration;
  deceleration_ = brake_ratio * acceleration;
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
  time_segments();
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

// The knot from which the stretch at s begins: the last one of this segment at or before s (or its
// first, when s lags); knots_.size() if there is no such segment.
std::size_t SpeedProfile::knot_at(double s, int segment) const {
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), s,
                                      [](double at, const Knot& knot) { return at < knot.s; });
  auto knot = after == knots_.begin() ? after : after - 1;
  while (knot != knots_.begin() && knot->segment > segment) --knot;
  while (knot != knots_.end() && knot->segment < segment) ++knot;
  return static_cast<std::size_t>(knot - knots_.begin());
}

double SpeedProfile::limit(double s, int segment, double dt) const {
  const std::size_t i = knot_at(s, segment);
  if (i + 1 >= knots_.size() || knots_[i].after == 0.0) return 0.0;
  const Knot& next = knots_[i + 1];
  if (next.segment != segment) return 0.0;
  return std::clamp(braking_speed(next.s - s, next.speed, deceleration_, dt), 0.0, knots_[i].after);
}

// From a speed that the profile allows: faster up to where the cap or the braking curve is met, at
// the cap up to the braking curve, or down that curve; not past the knot.
SpeedProfile::Phase SpeedProfile::next_phase(const State& state, double cap,
                                             const Knot& next) const {
  const double left = next.s - state.s;
  const double v2 = state.speed * state.speed;
  const double brake2 = next.speed * next.speed + 2.0 * deceleration_ * left;
  const double rate = state.speed < cap ? acceleration_ : 0.0;
  const double to_curve = (brake2 - v2) / (2.0 * (rate + deceleration_));
  if (to_curve <= kSame) return {left, next.speed};
  const double to_cap = rate > 0.0 ? (cap * cap - v2) / (2.0 * rate) : left;
  if (rate > 0.0 && to_cap <= std::min(to_curve, left)) return {to_cap, cap};
  const double distance = std::min(to_curve, left);
  return {distance, std::sqrt(v2 + 2.0 * rate * distance)};
}

// Drives for `dt` or to the segment's end, stretch by stretch, and returns the time used: infinite
// where it stands before the end.
double SpeedProfile::drive(State& state, int segment, double dt) const {
  double used = 0.0;
  std::size_t i = knot_at(state.s, segment);
  if (i < knots_.size()) state.s = std::max(state.s, knots_[i].s);
  for (; i + 1 < knots_.size() && knots_[i + 1].segment == segment; ++i) {
    const double cap = knots_[i].after;
    const Knot& next = knots_[i + 1];
    while (state.s < next.s) {
      state.speed = std::min(
          {state.speed, cap, braking_speed(next.s - state.s, next.speed, deceleration_, 0.0)});
      if (cap <= 0.0) return kEver;
      const Phase phase = next_phase(state, cap, next);
      const double mean = 0.5 * (state.speed + phase.speed);
      const double time = mean > 0.0 ? phase.distance / mean : 0.0;
      if (used + time > dt) {
        const double share = (dt - used) / time;
        const double gain = share * (phase.speed - state.speed);
        state.s += std::min(phase.distance, (state.speed + 0.5 * gain) * (dt - used));
        state.speed += gain;
        return dt;
      }
      used += time;
      state.s = phase.distance < next.s - state.s ? state.s + phase.distance : next.s;
      state.speed = phase.speed;
    }
  }
  if (i < knots_.size()) state.s = std::min(state.s, knots_[i].s);
  state.speed = 0.0;
  return used;
}

SpeedProfile::State SpeedProfile::advance(double s, double speed, int segment, double dt) const {
  State state{s, std::max(0.0, speed)};
  drive(state, segment, dt);
  return state;
}

void SpeedProfile::time_segments() {
  duration_ = 0.0;
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    if (i > 0 && knots_[i - 1].segment == knots_[i].segment) continue;
    State state{knots_[i].s, 0.0};
    duration_ += drive(state, knots_[i].segment, kEver);
  }
}

}  // namespace headland
