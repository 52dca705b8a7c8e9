// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "core/geometry/pose2.hpp"

namespace headland {

/// A straight or circular piece of a steering curve.
struct CurvePiece {
  double curvature = 0.0;  ///< [1/m], positive: steering to the left
  double length = 0.0;     ///< [m], signed: negative is driven in reverse
};

/// A short sequence of pieces that joins two poses (Dubins: 3, Reeds-Shepp: up to 5). A plain
/// value, without heap memory, so that planners can make millions.
class Curve {
 public:
  static constexpr int kMaxPieces = 5;

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
