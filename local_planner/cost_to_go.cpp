// SPDX-License-Identifier: Apache-2.0
#include "local_planner/cost_to_go.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace headland {
namespace {

constexpr double kTwoPi = 2.0 * kPi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// An angle in [0, 2 pi).
double turn(double angle) {
  while (angle < 0.0) angle += kTwoPi;
  while (angle >= kTwoPi) angle -= kTwoPi;
  return angle;
}

// The vehicle stands at the origin with heading +x; its left turning circle is around (0, r). Turns
// are counted from the circle's lowest point.
//
// A left turn and a straight: the straight points to the disc's centre, unless the turn itself runs
// into the disc. Infinite where the disc lies inside the circle.
double turn_and_straight(const Point2& g, double accuracy, double r) {
  const double across = std::hypot(g.x(), g.y() - r);  // from the circle's centre
  const double bearing = std::atan2(g.y() - r, g.x()) + 0.5 * kPi;
  const double straight = std::sqrt(std::max(0.0, across * across - r * r));
  if (across >= r && straight >= accuracy) {
    return r * turn(bearing - std::acos(std::min(1.0, r / across))) + straight - accuracy;
  }
  if (std::abs(across - r) > accuracy) return kInfinity;
  const double cosine = (r * r + across * across - accuracy * accuracy) / (2.0 * r * across);
  return r * turn(bearing - std::acos(std::clamp(cosine, -1.0, 1.0)));
}

// A right turn and then a left one that passes through the disc's centre.
double two_turns(const Point2& g, double accuracy, double r) {
  const Point2 first(0.0, -r);
  const Point2 to = g - first;
  const double d = to.norm();
  if (d > 3.0 * r || d < r) return kInfinity;
  // The triangle of the two centres (2 r apart) and the place (r from the second centre).
  const double at_first = std::acos(std::clamp((3.0 * r * r + d * d) / (4.0 * r * d), -1.0, 1.0));
  const double at_second =
      std::acos(std::clamp((5.0 * r * r - d * d) / (4.0 * r * r), -1.0, 1.0));
  const double bearing = std::atan2(to.y(), to.x());
  double best = kInfinity;
  for (const double side : {1.0, -1.0}) {
    const double line = bearing + side * at_first;  // from the first centre to the second
    const double right = turn(0.5 * kPi - line);
    const double left = turn(side * at_second);  // from the circles' contact to the place
    best = std::min(best, r * (right + left));
  }
  return std::max(0.0, best - accuracy);
}

}  // namespace

double forward_distance(const Point2& g, double accuracy, double radius) {
  const double distance = g.norm();
  if (distance <= accuracy) return 0.0;
  if (radius <= 0.0) return distance - accuracy;
  const Point2 mirrored(g.x(), -g.y());
  const double left = turn_and_straight(g, accuracy, radius);
  const double right = turn_and_straight(mirrored, accuracy, radius);
  double best = std::min(left, right);
  // Within reach of one turn there is nothing shorter.
  if (left == kInfinity) best = std::min(best, two_turns(g, accuracy, radius));
  if (right == kInfinity) best = std::min(best, two_turns(mirrored, accuracy, radius));
  return best;
}

double forward_distance(const Pose2& from, const Point2& place, double accuracy, double radius) {
  return forward_distance(Point2(inverse(from) * place), accuracy, radius);
}

}  // namespace headland
