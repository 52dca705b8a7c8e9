// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/pose2.hpp"

namespace headland::test {

/// Dubins' length by search: tries first turns all around, to both sides, and keeps those from
/// which a straight or a turn to the other side meets the goal's turning circle. No word formula.
class DubinsOracle {
 public:
  DubinsOracle(const Pose2& from, const Pose2& to, double radius)
      : from_(from), to_(to), radius_(radius) {}

  double length() {
    for (const double first : {1.0, -1.0}) {
      for (const double last : {1.0, -1.0}) {
        scan([&](double t) { return straight_gap(first, last, t); },
             [&](double t) { offer_straight(first, last, t); });
      }
      scan([&](double t) { return arc_gap(first, t); }, [&](double t) { offer_arc(first, t); });
    }
    return best_;
  }

 private:
  static constexpr int kSteps = 1000;

  // Calls `offer` at each root of `gap` over a full turn; looks closer where it nearly touches 0.
  template <typename Gap, typename Offer>
  static void scan(Gap gap, Offer offer) {
    const double step = 2.0 * kPi / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double low = i * step;
      const double high = low + step;
      const double middle = gap(0.5 * (low + high));
      const bool touching = std::abs(middle) < 10.0 * step * (1.0 + std::abs(gap(low) - gap(high)));
      const int parts = touching ? 100 : 1;
      for (int k = 0; k < parts; ++k) {
        root(gap, offer, low + step * k / parts, low + step * (k + 1) / parts);
      }
    }
  }

  template <typename Gap, typename Offer>
  static void root(Gap gap, Offer offer, double low, double high) {
    const bool rising = gap(low) < 0.0;
    if (rising == (gap(high) < 0.0)) return;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      ((gap(middle) < 0.0) == rising ? low : high) = middle;
    }
    offer(0.5 * (low + high));
  }

  Pose2 after(double side, double t) const { return advance(from_, side / radius_, t * radius_); }
  Point2 centre(const Pose2& pose, double side) const {
    return pose.position() + side * radius_ * pose.left();
  }
  // A turn to `side` that changes the heading by `change`; what is a hair below a circle is none.
  static double turn(double side, double change) { return wrap_positive(side * change, 1e-7); }

  // How far the line of the heading misses being a tangent of the goal's circle.
  double straight_gap(double first, double last, double t) const {
    const Pose2 pose = after(first, t);
    return (centre(to_, last) - pose.position()).dot(pose.left()) - last * radius_;
  }
  void offer_straight(double first, double last, double t) {
    const Pose2 pose = after(first, t);
    const double straight = (centre(to_, last) - pose.position()).dot(pose.heading());
    if (straight < -1e-9) return;
    offer(t + straight / radius_ + turn(last, to_.yaw - pose.yaw));
  }

  // How far the other circle at the pose misses touching the goal's circle.
  double arc_gap(double first, double t) const {
    return (centre(after(first, t), -first) - centre(to_, first)).norm() - 2.0 * radius_;
  }
  void offer_arc(double first, double t) {
    const Pose2 pose = after(first, t);
    const Point2 middle = centre(pose, -first);
    const Point2 out = pose.position() - middle;
    const Point2 touch = 0.5 * (centre(to_, first) - middle);
    const double second =
        turn(-first, std::atan2(touch.y(), touch.x()) - std::atan2(out.y(), out.x()));
    offer(t + second + turn(first, to_.yaw - (pose.yaw - first * second)));
  }

  void offer(double radians) { best_ = std::min(best_, radians * radius_); }

  Pose2 from_;
  Pose2 to_;
  double radius_;
  double best_ = std::numeric_limits<double>::infinity();
};

}  // namespace headland::test
