// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/clothoid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace headland {
namespace {

struct Node {
  double place = 0.0;  // in [-1, 1]
  double weight = 0.0;
};
// Gauss-Legendre quadrature of 8 and of 4 points, the negative places left out.
constexpr std::array<Node, 4> kNodes = {{{0.1834346424956498, 0.3626837833783620},
                                         {0.5255324099163290, 0.3137066458778873},
                                         {0.7966664774136267, 0.2223810344533745},
                                         {0.9602898564975363, 0.1012285362903763}}};
constexpr std::array<Node, 2> kFewNodes = {
    {{0.3399810435848563, 0.6521451548625461}, {0.8611363115940526, 0.3478548451374538}}};
// A panel turns no faster than by this [rad]: then 8 points integrate sine and cosine to 2e-12.
constexpr double kPanelTurn = 2.0;
// So do 4 on a short stretch, that turns and bends no more than this [rad].
constexpr double kShortTurn = 0.2;
constexpr double kShortBend = 0.01;
constexpr double kMostPanels = 10000.0;

constexpr int kMostIterations = 10;
constexpr double kConverged = 1e-12;  // of the chord's unit length
constexpr double kLeastAdvance = 1e-9;

template <std::size_t N, typename Add>
void integrate_panel(const std::array<Node, N>& nodes, double middle, double half, Add& add) {
  for (const Node& node : nodes) {
    add(middle - half * node.place, half * node.weight);
    add(middle + half * node.place, half * node.weight);
  }
}

/// Calls add(t, weight) for the nodes of a quadrature over [0, 1] of functions of the angle
/// bend t^2 + rate t [rad].
template <typename Add>
void integrate(double bend, double rate, Add add) {
  const double most_rate = std::max(std::abs(rate), std::abs(rate + 2.0 * bend));
  if (most_rate <= kShortTurn && std::abs(bend) <= kShortBend) {
    return integrate_panel(kFewNodes, 0.5, 0.5, add);
  }
  // Written so that a NaN takes one panel.
  const double turns = most_rate > kPanelTurn ? std::ceil(most_rate / kPanelTurn) : 1.0;
  const int panels = static_cast<int>(std::min(turns, kMostPanels));
  const double half = 0.5 / panels;
  for (int i = 0; i < panels; ++i) integrate_panel(kNodes, (2 * i + 1) * half, half, add);
}

/// Bertolazzi and Frego 2015, Sec. 5: the chord's unit interval with the angle
/// A t^2 + (delta - A) t + phi0 to it.
struct ChordIntegrals {
  double along = 0.0;   // of the cosine: the chord over the length
  double across = 0.0;  // of the sine, g(A): zero where the curve ends on the chord
  double slope = 0.0;   // g'(A)
};

ChordIntegrals chord_integrals(double a, double delta, double phi0) {
  ChordIntegrals sum;
  integrate(a, delta - a, [&](double t, double weight) {
    const double angle = (a * t + (delta - a)) * t + phi0;
    const double cosine = weight * std::cos(angle);
    sum.along += cosine;
    sum.across += weight * std::sin(angle);
    sum.slope += (t * t - t) * cosine;
  });
  return sum;
}

/// The first guess of A: the same paper's polynomial in the two angles.
double first_guess(double phi0, double phi1) {
  constexpr std::array<double, 6> c = {2.989696028701907,  0.716228953608281, -0.458969738821509,
                                       -0.502821153340377, 0.261062141752652, -0.045854475238709};
  const double x = phi0 / kPi;
  const double y = phi1 / kPi;
  const double xy = x * y;
  const double squares = x * x + y * y;
  const double fourths = x * x * x * x + y * y * y * y;
  return (phi0 + phi1) *
         (c[0] + xy * (c[1] + xy * c[2]) + (c[3] + xy * c[4]) * squares + c[5] * fourths);
}

}  // namespace

Pose2 advance(const Pose2& from, double curvature, double sharpness, double distance) {
  if (sharpness == 0.0) return advance(from, curvature, distance);
  const double rate = curvature * distance;
  const double bend = 0.5 * sharpness * distance * distance;
  Point2 sum(0.0, 0.0);
  integrate(bend, rate, [&](double t, double weight) {
    const double yaw = from.yaw + (bend * t + rate) * t;
    sum += weight * Point2(std::cos(yaw), std::sin(yaw));
  });
  return {from.x + distance * sum.x(), from.y + distance * sum.y(), from.yaw + rate + bend};
}

double Clothoid::max_abs_curvature() const {
  return std::max(std::abs(curvature), std::abs(curvature_at(length)));
}

std::optional<ClothoidFit> fit_clothoid(const Pose2& from, const Pose2& to) {
  const Point2 chord = to.position() - from.position();
  const double distance = chord.norm();
  if (!(distance > 0.0)) return std::nullopt;
  const double bearing = std::atan2(chord.y(), chord.x());
  const double phi0 = wrap_angle(from.yaw - bearing);
  const double phi1 = wrap_angle(to.yaw - bearing);
  const double delta = phi1 - phi0;

  double a = first_guess(phi0, phi1);
  ChordIntegrals at = chord_integrals(a, delta, phi0);
  int iterations = 1;
  for (; std::abs(at.across) > kConverged && iterations < kMostIterations; ++iterations) {
    a -= at.across / at.slope;
    at = chord_integrals(a, delta, phi0);
  }
  if (!(std::abs(at.across) <= kConverged && at.along > kLeastAdvance)) return std::nullopt;
  const double length = distance / at.along;
  return ClothoidFit{{from, (delta - a) / length, 2.0 * a / (length * length), length}, iterations};
}

}  // namespace headland
