// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "core/config/visit.hpp"
#include "core/geometry/clothoid.hpp"
#include "core/geometry/curve.hpp"

namespace headland {

enum class Gear : std::int8_t { kForward = 1, kReverse = -1 };

constexpr double sign(Gear gear) { return gear == Gear::kForward ? 1.0 : -1.0; }

/// One piece of a path, exact: a straight, an arc or a clothoid.
struct PathPiece {
  Pose2 start;  ///< of the vehicle's base in `map`; its heading, not its direction of travel
  double curvature = 0.0;  ///< [1/m] of the steering at the start, positive left, in both gears
  double length = 0.0;     ///< driven distance [m], > 0
  Gear gear = Gear::kForward;
  int leg = 0;             ///< the plan's leg (row, turn, transit) this piece belongs to
  double sharpness = 0.0;  ///< change of curvature per driven metre [1/m2]; 0: straight or arc

  /// After `driven` [m] of it.
  Pose2 pose_at(double driven) const {
    return advance(start, curvature, sign(gear) * sharpness, sign(gear) * driven);
  }
  double curvature_at(double driven) const { return curvature + sharpness * driven; }  ///< [1/m]
  double end_curvature() const { return curvature_at(length); }                        ///< [1/m]
};

/// The same ground driven the other way in the same gear, the vehicle looking back.
PathPiece turned_round(const PathPiece& piece);

/// A point of a path, with all a controller needs to know of it.
struct PathSample {
  Pose2 pose;
  double s = 0.0;          ///< driven distance from the path's start [m]
  double curvature = 0.0;  ///< [1/m], positive left
  Gear gear = Gear::kForward;
  int segment = 0;  ///< counts the changes of gear; a controller never looks past its end
  int leg = 0;
};

/// A stretch of one gear; two neighbours meet at a cusp.
struct PathSegment {
  double begin_s = 0.0;  ///< [m]
  double end_s = 0.0;    ///< [m]
  Gear gear = Gear::kForward;
};

/// Nearest point of a path, and the errors there.
struct Projection {
  double s = 0.0;              ///< [m]
  double lateral_error = 0.0;  ///< [m], positive: the point lies to the left of the path's heading
  double distance = 0.0;       ///< [m], >= 0
};

/// A path of exact pieces: what the planner makes, the controller follows and errors are measured
/// against. Not a polyline: samples are derived from it.
class Path {
 public:
  /// Appends a piece. It must start where the path ends, within 1e-6 m and rad (checked).
  void append(const PathPiece& piece);
  /// Appends the pieces of a steering curve that starts at `from`.
  void append(const Curve& curve, const Pose2& from, int leg);
  /// Appends a clothoid.
  void append(const Clothoid& clothoid, int leg);
  /// Appends a forward straight line of `length` [m] from `from`; nothing if it is not positive.
  void append_straight(const Pose2& from, double length, int leg);
  /// Appends all of another path, its leg numbers raised by `leg_offset`.
  void append(const Path& other, int leg_offset = 0);

  bool empty() const { return pieces_.empty(); }
  double length() const { return ends_.empty() ? 0.0 : ends_.back(); }
  const std::vector<PathPiece>& pieces() const { return pieces_; }
  const std::vector<PathSegment>& segments() const { return segments_; }
  Pose2 start_pose() const;
  Pose2 end_pose() const;

  /// The sample at driven distance `s` [m], clamped to the path. At a piece's border the later
  /// piece counts. O(log pieces).
  PathSample at(double s) const;
  /// Samples at most `spacing` [m] apart; the ends of all pieces are among them.
  std::vector<PathSample> sample(double spacing) const;
  /// The nearest point with s in [from_s, to_s]; exact on lines and arcs, to rounding on
  /// clothoids. O(pieces in the window).
  Projection project(const Point2& p_map, double from_s, double to_s) const;
  /// Driven distance [m] at which leg number `leg` begins and ends; {0, 0} if the path has no such
  /// leg.
  std::pair<double, double> leg_range(int leg) const;
  /// The stretch between two driven distances [m], clamped to the path; its legs keep their numbers.
  Path slice(double from_s, double to_s) const;

 private:
  std::vector<PathPiece> pieces_;
  std::vector<double> ends_;  // driven distance at the end of each piece
  std::vector<PathSegment> segments_;
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::Gear> {
  static constexpr std::pair<headland::Gear, std::string_view> values[] = {
      {headland::Gear::kForward, "forward"}, {headland::Gear::kReverse, "reverse"}};
};
