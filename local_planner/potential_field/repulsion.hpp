// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"

namespace headland {

/// What repels: an agent or the nearest static obstacle.
struct PotentialSource {
  double gap = 0.0;           ///< outline to its border [m]; negative: overlap
  Point2 towards{1.0, 0.0};   ///< unit vector from the vehicle to it [map]
  Point2 velocity{0.0, 0.0};  ///< its own [m/s, map]
};

/// The field of seed 003's authors (stuarteiffert/MCTS-GRNN): U = (1 + S) D^2, with D the distance
/// to the goal and S = sum of strength / (1 + (d / width)^6) over agents nearer than `reach_m`.
struct SeedRepulsion {
  double strength_ratio = 5.0;
  double width_m = 1.0;
  double reach_m = 2.5;

  template <class V>
  void visit(V& v) {
    v("strength_ratio", strength_ratio, config::kNonNegative, "Of an agent at contact");
    v("width_m", width_m, config::kPositive, "Here it is half as strong [m]");
    v("reach_m", reach_m, config::kPositive, "Beyond this it is not felt [m]");
  }

  /// The push of all sources, where the aim's pull is 1: -grad S * D / (2 (1 + S)).
  /// @param distance D, to the aim [m].
  Point2 push(std::span<const PotentialSource> sources, double distance, double swirl,
              const Point2& pull) const;
};

/// The field of Ge and Cui (2002), U = strength (1 / (gap - braking) - 1 / reach) while the vehicle
/// and the source come nearer, with braking = (closing speed)^2 / (2 acceleration).
struct VelocityRepulsion {
  double strength_m = 0.2;
  double reach_m = 2.5;
  double margin_m = 0.3;
  double acceleration_mps2 = 4.0;  ///< more than the robot has: others move, too

  template <class V>
  void visit(V& v) {
    v("strength_m", strength_m, config::kNonNegative, "Against the aim's pull of 1 [m]");
    v("reach_m", reach_m, config::kPositive, "Beyond this and the braking it is not felt [m]");
    v("margin_m", margin_m, config::kNonNegative, "Kept free between outline and agents [m]");
    v("acceleration_mps2", acceleration_mps2, config::kPositive,
      "With which relative motion can be stopped [m/s2]");
  }

  /// Its force by position and by velocity; `velocity` is the vehicle's [m/s].
  Point2 push(std::span<const PotentialSource> sources, const Point2& velocity, double swirl,
              const Point2& pull) const;
};

}  // namespace headland
