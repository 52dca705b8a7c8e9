// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/geometry/curve.hpp"

namespace headland {

/// The fishtail (switch-back) headland turn as a true three-piece manoeuvre: a forward arc, a
/// straight in reverse, a forward arc. Between two antiparallel rows at a distance d < 2 R it is
/// two quarter circles and 2 R - d in reverse: (pi + 2) R - d in all. General poses get the arcs
/// that make the straight piece meet both circles (both turns to the same side).
/// Of the turns to the two sides it is the shorter one; rows further apart than 2 R leave only the
/// one that swings away from the next row, (pi + 2) R + d, which no planner wants.
/// @return None where the straight piece would not run in reverse (then Dubins is shorter).
std::optional<Curve> fishtail(const Pose2& from, const Pose2& to, double radius);

}  // namespace headland
