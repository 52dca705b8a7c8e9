// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/geometry/path.hpp"

namespace headland::roadmap {

/// How a vehicle may drive in free space, and what that costs, in metres driven forwards.
struct DriveRules {
  double radius = 1.0;           ///< of the tightest turn [m]
  bool reverses = true;          ///< may use the reverse gear
  double reverse_weight = 1.0;   ///< of a metre in reverse
  double cusp_cost = 0.0;        ///< of a change of gear [m]
  double steering_weight = 0.0;  ///< of a radian turned [m]

  double cost(const CurvePiece& piece) const;
  /// With the changes of gear inside the curve.
  double cost(const Curve& curve) const;
  double cost(const Path& path) const;
  /// Length of the shortest way over open ground [m]: a lower bound of any cost.
  double open_distance(const Pose2& from, const Pose2& to) const;
};

/// A curve that joins two poses, and its cost.
struct Join {
  double cost = 0.0;
  Curve curve;

  Gear first_gear() const { return gear_of(*curve.begin()); }
  Gear last_gear() const { return gear_of(*(curve.end() - 1)); }
  static Gear gear_of(const CurvePiece& piece) {
    return piece.length > 0.0 ? Gear::kForward : Gear::kReverse;
  }
};

/// The Dubins curve, and for a vehicle that reverses also the Dubins curve driven backwards and the
/// Reeds-Shepp curve; cheapest first, none empty.
std::vector<Join> joins(const DriveRules& rules, const Pose2& from, const Pose2& to);

/// Collects the pieces of a path; neighbours of one curvature and gear become one, and pieces of
/// mere rounding go.
class PathBuilder {
 public:
  void add(PathPiece piece);
  void add(const Pose2& from, const CurvePiece& piece);
  void add(const Pose2& from, const Curve& curve);
  Path path() const;

 private:
  std::vector<PathPiece> pieces_;
};

}  // namespace headland::roadmap
