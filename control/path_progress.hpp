// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/path.hpp"

namespace headland {

/// How far along a path a vehicle is, segment by segment: progress never decreases and never leaves
/// the segment under way, as the path runs back on itself behind a cusp. Does not allocate.
class PathProgress {
 public:
  /// At the begin of a path, which must outlive its use and not be empty.
  void start(const Path& path);
  /// On to the next segment, at its begin.
  void next_segment();

  const PathSegment& segment() const {
    return path_->segments()[static_cast<std::size_t>(number_)];
  }
  int number() const { return number_; }  ///< of the segment
  bool on_last() const { return number_ + 1 == static_cast<int>(path_->segments().size()); }
  double s() const { return s_; }  ///< [m]
  /// `s` [m], clamped to the segment.
  double inside(double s) const;

  /// The nearest point of the segment within `search` [m] of the progress.
  Projection nearest(const Point2& p_map, double search) const;
  /// To the end of the segment [m]: near it, the signed distance along its tangent, which goes
  /// through zero however far the vehicle passes beside the end. `s`: of the nearest point.
  double remaining(const Pose2& pose, double s) const;
  /// The progress is `s` [m], but not less than it was, and not on a cusp.
  void move_to(double s);

  /// Path::at() at a segment's end is already the next segment; this much before it is not [m].
  static constexpr double kBeforeEnd = 1e-9;

 private:
  const Path* path_ = nullptr;
  int number_ = 0;
  double s_ = 0.0;
};

}  // namespace headland
