// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/geometry/clothoid.hpp"

namespace headland {

/// A straight, an arc or a clothoid of a steering curve.
struct CurvePiece {
  double curvature = 0.0;  ///< at its start [1/m], positive: steering to the left
  double length = 0.0;     ///< [m], signed: negative is driven in reverse
  double sharpness = 0.0;  ///< change of curvature per signed metre [1/m2]; 0: straight or arc

  double end_curvature() const { return curvature + sharpness * length; }         ///< [1/m]
  double mean_curvature() const { return curvature + 0.5 * sharpness * length; }  ///< [1/m]
  double max_abs_curvature() const {                                              ///< [1/m]
    return std::max(std::abs(curvature), std::abs(end_curvature()));
  }
  /// After the signed distance u [m] of it, begun at `from`.
  Pose2 pose_at(const Pose2& from, double u) const {
    return sharpness == 0.0 ? advance(from, curvature, u) : advance(from, curvature, sharpness, u);
  }
  Pose2 end_pose(const Pose2& from) const { return pose_at(from, length); }
};

/// A short sequence of pieces that joins two poses (Dubins: 3, Reeds-Shepp: up to 5, three turns
/// with clothoids: 9). A plain value, without heap memory, so that planners can make millions.
class Curve {
 public:
  static constexpr int kMaxPieces = 9;

  /// Appends a piece; pieces of zero length are dropped. Requires count() < kMaxPieces.
  void add(CurvePiece piece) {
    if (piece.length != 0.0) pieces_[static_cast<std::size_t>(count_++)] = piece;
  }
  int count() const { return count_; }
  const CurvePiece* begin() const { return pieces_.data(); }
  const CurvePiece* end() const { return pieces_.data() + count_; }

  /// Driven distance, forward and reverse [m].
  double length() const;
  /// Number of changes of gear inside the curve.
  int cusps() const;
  /// Where the curve ends when started at `from`.
  Pose2 end_pose(const Pose2& from) const;
  /// Letters and signs, such as "L+R-L+", for reports and tests.
  std::string word() const;

 private:
  std::array<CurvePiece, kMaxPieces> pieces_{};
  int count_ = 0;
};

/// Distance [m] and heading [rad] by which `curve`, started at `from`, misses `to`.
struct EndError {
  double position = 0.0;
  double yaw = 0.0;
};
EndError end_error(const Curve& curve, const Pose2& from, const Pose2& to);

}  // namespace headland
