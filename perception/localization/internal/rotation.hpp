// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Geometry>

namespace headland::internal {

/// The matrix with cross(a) * b = a x b.
inline Eigen::Matrix3d cross(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

/// The rotation by |a| [rad] about a.
inline Eigen::Matrix3d rotation_by(const Eigen::Vector3d& a) {
  const double angle = a.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity() + cross(a);
  return Eigen::AngleAxisd(angle, a / angle).toRotationMatrix();
}

/// The vector that rotation_by() makes this rotation of.
inline Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

/// Two unit vectors that span the plane across `a`.
inline Eigen::Matrix<double, 3, 2> across(const Eigen::Vector3d& a) {
  const Eigen::Vector3d n = a.normalized();
  const Eigen::Vector3d first = n.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> basis;
  basis << first, n.cross(first);
  return basis;
}

}  // namespace headland::internal
