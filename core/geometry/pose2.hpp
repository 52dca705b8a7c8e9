// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "core/geometry/angle.hpp"

namespace headland {

using Point2 = Eigen::Vector2d;  ///< [m]

/// Position [m] and heading [rad, counter-clockwise from east] of a frame in the plane.
/// Also the transform between two frames: T_map_base is the pose of `base` in `map`.
struct Pose2 {
  double x = 0.0;    ///< [m]
  double y = 0.0;    ///< [m]
  double yaw = 0.0;  ///< [rad]; not wrapped by arithmetic

  Point2 position() const { return {x, y}; }
  /// Unit vector along +x of the frame.
  Point2 heading() const { return {std::cos(yaw), std::sin(yaw)}; }
  /// Unit vector along +y of the frame (to the left).
  Point2 left() const { return {-std::sin(yaw), std::cos(yaw)}; }
};

/// T_a_c = T_a_b * T_b_c.
inline Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) {
  const double c = std::cos(T_a_b.yaw);
  const double s = std::sin(T_a_b.yaw);
  return {T_a_b.x + c * T_b_c.x - s * T_b_c.y, T_a_b.y + s * T_b_c.x + c * T_b_c.y,
          T_a_b.yaw + T_b_c.yaw};
}

/// p_a = T_a_b * p_b.
inline Point2 operator*(const Pose2& T_a_b, const Point2& p_b) {
  const double c = std::cos(T_a_b.yaw);
  const double s = std::sin(T_a_b.yaw);
  return {T_a_b.x + c * p_b.x() - s * p_b.y(), T_a_b.y + s * p_b.x() + c * p_b.y()};
}

inline Pose2 inverse(const Pose2& T_a_b) {
  const double c = std::cos(T_a_b.yaw);
  const double s = std::sin(T_a_b.yaw);
  return {-c * T_a_b.x - s * T_a_b.y, s * T_a_b.x - c * T_a_b.y, -T_a_b.yaw};
}

/// The same place, looking back.
inline Pose2 reversed(const Pose2& pose) { return {pose.x, pose.y, pose.yaw + kPi}; }

/// The pose after driving the signed `distance` [m] (negative: backwards) with the steering held at
/// `curvature` [1/m, positive left]. Exact; smooth at zero curvature.
Pose2 advance(const Pose2& from, double curvature, double distance);

}  // namespace headland
