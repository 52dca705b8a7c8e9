// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/geometry/smooth_turn.hpp"

namespace headland {

/// The three-point turn: an arc forwards, one in reverse with the steering thrown over, an arc
/// forwards; with the clothoids of `turn` where it leaves the start and where it reaches the goal.
/// At its cusps the curvature steps: there the wheels are turned at a standstill. Without clothoids
/// all of its kind between antiparallel rows nearer than 2 R are pi R long, the shortest
/// Reeds-Shepp curve among them.
/// @param hand 1: begins with a left turn, -1: with a right turn.
/// @return None where the poses are too far apart, or an arc would turn by less than its clothoid.
std::optional<Curve> three_point_turn(const Pose2& from, const Pose2& to, const SmoothTurn& turn,
                                      double hand);

}  // namespace headland
