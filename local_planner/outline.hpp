// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/model/kinematics.hpp"
#include "core/model/vehicle.hpp"
#include "core/world/clearance_map.hpp"

namespace headland {

/// Distance [m] from a point, given in `base`, to the vehicle's outline; 0 inside.
inline double outline_distance(const Footprint& outline, const Point2& p_base) {
  const double along = std::max({p_base.x() - outline.front_m, -outline.rear_m - p_base.x(), 0.0});
  const double across = std::max(std::abs(p_base.y()) - 0.5 * outline.width_m, 0.0);
  return std::sqrt(along * along + across * across);
}

/// How fast [m/s] the vehicle's outline moves towards a point of the map where it is nearest to it.
/// Of a point inside, the vehicle's speed.
inline double outline_closing(const Vehicle& vehicle, const VehicleState& state, const Point2& p) {
  const Footprint& outline = vehicle.footprint;
  const Point2 p_base = inverse(state.pose) * p;
  const double half = 0.5 * outline.width_m;
  const Point2 edge(std::clamp(p_base.x(), -outline.rear_m, outline.front_m),
                    std::clamp(p_base.y(), -half, half));
  const double rate = vehicle.steering == Steering::kAckermann
                          ? state.speed * std::tan(state.steering) / vehicle.wheelbase_m
                          : state.yaw_rate;
  const Point2 velocity(state.speed - rate * edge.y(), rate * edge.x());
  const Point2 towards = p_base - edge;
  return towards.norm() > 1e-9 ? velocity.dot(towards.normalized()) : std::abs(state.speed);
}

/// Discs along the vehicle's middle line that cover its outline: what is looked up in a
/// ClearanceMap. They reach at most `excess` [m] beyond the sides.
class OutlineDiscs {
 public:
  explicit OutlineDiscs(const Footprint& outline, double excess = 0.1);

  /// How far the outline is from static obstacles [m], at least; negative: it may touch one (the
  /// discs and the map's cells are larger than the truth). A lookup per disc.
  double free(const ClearanceMap& map, const Pose2& T_map_base) const {
    const Point2 heading = T_map_base.heading();
    double nearest = ClearanceMap::kFar;
    for (const double ahead : ahead_) {
      nearest = std::min(nearest, map.clearance(T_map_base.position() + ahead * heading));
    }
    return nearest - radius_;
  }

 private:
  double radius_;              // of each disc [m]
  std::vector<double> ahead_;  // of the base [m]
};

/// The one disc that holds the outline.
struct OutlineDisc {
  double ahead = 0.0;   ///< its centre, of the base [m]
  double radius = 0.0;  ///< [m]

  explicit OutlineDisc(const Footprint& outline)
      : ahead(0.5 * (outline.front_m - outline.rear_m)),
        radius(std::hypot(0.5 * (outline.front_m + outline.rear_m), 0.5 * outline.width_m)) {}
  Point2 centre(const Pose2& T_map_base) const {
    return T_map_base.position() + ahead * T_map_base.heading();
  }
};

}  // namespace headland
