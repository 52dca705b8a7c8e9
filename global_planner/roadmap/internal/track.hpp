// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "core/geometry/path.hpp"
#include "core/geometry/region.hpp"
#include "core/model/vehicle.hpp"
#include "core/world/ground.hpp"
#include "global_planner/roadmap/roadmap.hpp"

namespace headland::internal {

/// A way from pose to pose, driven forwards: one clothoid, or up to three pieces of a Dubins curve.
/// The same ground may be driven the other way, from the end looking back to the start.
struct Track {
  std::array<PathPiece, 3> pieces{};
  int count = 0;  ///< none: the poses are the same

  double length() const;  ///< [m]
  Path path(bool backwards = false) const;
};

/// Which of a track's two ways may be driven.
struct Ways {
  bool forwards = true;
  bool backwards = true;
  bool any() const { return forwards || backwards; }
};

/// Makes tracks for a vehicle, and tells where it may drive them.
class TrackMaker {
 public:
  TrackMaker(const Region& drivable, const Ground& ground, const Vehicle& vehicle, EdgeCurve curve);

  /// The track by that curve, or none where it bends more than the vehicle can or goes a long way
  /// round.
  std::optional<Track> join(const Pose2& from, const Pose2& to, EdgeCurve curve) const;
  std::optional<Track> join(const Pose2& from, const Pose2& to) const {
    return join(from, to, curve_);
  }

  /// True if the vehicle may stand there: outline widened by `margin` [m] inside, slopes in limits.
  bool fits(const Pose2& pose, double margin) const;
  /// Those of the `wanted` ways of a track that fit all along.
  Ways open_ways(const Track& track, double margin, Ways wanted = {}) const;
  /// None where the terrain has a hole.
  std::optional<DriveCost> cost(const Track& track, bool backwards = false) const;
  /// Height of the ground [m]; 0 off the terrain.
  double height(const Point2& p_map) const;

  const Region& drivable() const { return drivable_; }
  double radius() const { return radius_; }  ///< [m]

 private:
  bool level_enough(const Point2& place, const Point2& heading) const;
  template <class Visit>
  static void walk(const PathPiece& piece, double longest, Visit visit);
  template <class Visit>
  static void walk(const Track& track, double longest, Visit visit);
  void check_outline(const Pose2& pose, double margin, Ways& open) const;

  const Region& drivable_;
  const Ground& ground_;
  const Vehicle& vehicle_;
  EdgeCurve curve_;
  double radius_;
  double step_;        // between samples of a track [m]
  double stray_;       // of a point of the outline from where it is at the nearest sample [m]
  double sweep_;       // and from the line between two samples: the sagitta [m]
  Footprint both_;     // the outline in both headings
  double most_pitch_;  // tangent
  double most_roll_;   // tangent
};

}  // namespace headland::internal
