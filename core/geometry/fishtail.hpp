// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/geometry/smooth_turn.hpp"

namespace headland {

/// The fishtail (switch-back) headland turn as a true three-piece manoeuvre: a forward arc, a
/// straight in reverse, a forward arc. Between two antiparallel rows at a distance d < 2 R it is
/// two quarter circles and 2 R - d in reverse: (pi + 2) R - d in all. General poses get the arcs
/// that make the straight piece meet both circles (both turns to the same side).
/// Of the turns to the two sides it is the shorter one; rows further apart than 2 R leave only the
/// one that swings away from the next row, (pi + 2) R + d, which no planner wants.
/// @return None where the straight piece would not run in reverse (then Dubins is shorter).
std::optional<Curve> fishtail(const Pose2& from, const Pose2& to, double radius);

/// The same with the clothoids of `turn` where it leaves the start and where it reaches the goal,
/// both with the wheels straight. At its cusps the curvature steps: there the wheels are turned at
/// a standstill. None too where an arc would turn by less than its clothoid.
std::optional<Curve> fishtail(const Pose2& from, const Pose2& to, const SmoothTurn& turn);

}  // namespace headland
