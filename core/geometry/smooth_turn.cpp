// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/smooth_turn.hpp"

namespace headland {
namespace {

constexpr int kTerms = 16;
constexpr int kFewTerms = 7;     // enough for half a turn of
constexpr double kLittle = 0.6;  // [rad]

// The two clothoids of a turn by 2 a, as long as 1 each, have a chord of 2 g(a), where
// g(a) = integral over [0, 1] of cos(a (1 - t^2)): a series in a^2. The integral of (1 - t^2)^n is
// the product of 2 k / (2 k + 1) for k = 1 .. n.
constexpr std::array<double, kTerms> series() {
  std::array<double, kTerms> terms{};
  double term = 1.0;
  for (int k = 0; k < kTerms; ++k) {
    terms[static_cast<std::size_t>(k)] = term;
    for (const int n : {2 * k + 1, 2 * k + 2}) term *= 2.0 / (2.0 * n + 1.0);
    term = -term;
  }
  return terms;
}
constexpr std::array<double, kTerms> kSeries = series();

struct HalfChord {
  double value = 0.0;
  double slope = 0.0;
};

HalfChord half_chord(double a) {
  const double square = a * a;
  double value = 0.0;
  double slope = 0.0;  // of the value by the square
  for (int k = a < kLittle ? kFewTerms : kTerms; k-- > 0;) {
    slope = slope * square + value;
    value = value * square + kSeries[static_cast<std::size_t>(k)];
  }
  return {value, 2.0 * a * slope};
}

}  // namespace

SmoothTurn::SmoothTurn(const SteeringLimits& limits)
    : radius_(1.0 / limits.curvature), sharpness_(limits.sharpness) {
  ramp_ = limits.curvature * limits.curvature / limits.sharpness;
  if (!(ramp_ > 0.0)) return;
  inverse_ramp_ = 1.0 / ramp_;
  const Pose2 at_arc = advance({}, 0.0, inverse_ramp_, ramp_);
  ahead_ = at_arc.x - std::sin(at_arc.yaw);
  aside_ = at_arc.y + std::cos(at_arc.yaw);
}

SmoothTurn::Shape SmoothTurn::shape(double angle) const {
  Shape turn;
  const double half = 0.5 * angle;
  turn.sine = std::sin(half);
  turn.cosine = std::cos(half);
  if (angle >= least_with_arc()) {
    turn.chord = 2.0 * (aside_ * turn.sine + ahead_ * turn.cosine);
    turn.slope = aside_ * turn.cosine - ahead_ * turn.sine;
    return turn;
  }
  if (angle <= 0.0) return turn;
  const HalfChord unit = half_chord(half);
  const double ramp = std::sqrt(angle * ramp_);
  turn.chord = 2.0 * ramp * unit.value;
  turn.slope = ramp * (unit.value / angle + unit.slope);
  return turn;
}

double SmoothTurn::length(double angle) const {
  return angle >= least_with_arc() ? angle + ramp_ : 2.0 * std::sqrt(std::max(angle, 0.0) * ramp_);
}

void SmoothTurn::append(Curve& curve, double angle, double hand, double rounding) const {
  if (angle <= rounding) {
    const double straight = shape(angle).chord;
    if (straight > rounding) curve.add({0.0, straight * radius_});
    return;
  }
  if (!has_ramps()) {
    curve.add({hand / radius_, angle * radius_});
    return;
  }
  const double arc = angle - least_with_arc();
  const double ramp = radius_ * (arc >= 0.0 ? ramp_ : std::sqrt(angle * ramp_));
  const double bend = arc >= 0.0 ? 1.0 / radius_ : sharpness_ * ramp;
  curve.add({0.0, ramp, hand * sharpness_});
  if (arc > rounding) curve.add({hand / radius_, arc * radius_});
  curve.add({hand * bend, ramp, -hand * sharpness_});
}

}  // namespace headland
