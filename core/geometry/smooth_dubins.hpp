// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/smooth_turn.hpp"

namespace headland {

/// A short forward curve of continuous curvature, zero at both ends, between two poses: two turns
/// and a straight between them, or three turns (Fraichard and Scheuer 2004, with the sharpest turns
/// wherever the arc vanishes). Dubins' shortest curve where `turn` has no ramps, and nearly so
/// where they are short. There always is one: where the poses are too near to each other for
/// anything else, it turns right round.
///
/// Not the shortest of all curves of bounded sharpness, but of those of whole turns. The end pose
/// is met to 1e-9, as by shortest_dubins. Mirrored poses give the mirrored curve. Deterministic,
/// thread-safe, does not allocate.
Curve smooth_dubins(const Pose2& from, const Pose2& to, const SmoothTurn& turn);

/// Its length [m] alone.
double smooth_dubins_length(const Pose2& from, const Pose2& to, const SmoothTurn& turn);

}  // namespace headland
