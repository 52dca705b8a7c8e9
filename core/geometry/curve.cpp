// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/curve.hpp"

#include <cmath>

namespace headland {

double Curve::length() const {
  double total = 0.0;
  for (const CurvePiece& piece : *this) total += std::abs(piece.length);
  return total;
}

int Curve::cusps() const {
  int changes = 0;
  for (int i = 1; i < count_; ++i) {
    const auto k = static_cast<std::size_t>(i);
    changes += (pieces_[k].length > 0.0) != (pieces_[k - 1].length > 0.0) ? 1 : 0;
  }
  return changes;
}

Pose2 Curve::end_pose(const Pose2& from) const {
  Pose2 pose = from;
  for (const CurvePiece& piece : *this) pose = piece.end_pose(pose);
  return pose;
}

std::string Curve::word() const {
  std::string text;
  for (const CurvePiece& piece : *this) {
    const double bend = piece.mean_curvature();
    text += bend > 0.0 ? 'L' : bend < 0.0 ? 'R' : 'S';
    text += piece.length > 0.0 ? '+' : '-';
  }
  return text;
}

EndError end_error(const Curve& curve, const Pose2& from, const Pose2& to) {
  const Pose2 reached = curve.end_pose(from);
  return {(reached.position() - to.position()).norm(), std::abs(wrap_angle(reached.yaw - to.yaw))};
}

}  // namespace headland
