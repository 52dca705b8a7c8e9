// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/curve.hpp"

namespace headland {

/// The shortest forward path of bounded curvature between two poses (Dubins 1957; words after Shkel
/// and Lumelsky 2001). Exact at degenerate poses too (identical, one arc apart, goal on a turning
/// circle): no spurious full circle, and the end pose is verified and polished to 1e-9.
/// @param radius Minimum turning radius [m], > 0 (not checked: this is the inner loop).
/// Deterministic, thread-safe, does not allocate.
Curve shortest_dubins(const Pose2& from, const Pose2& to, double radius);

/// Its length [m] alone; cheaper where only the cost is wanted.
double dubins_length(const Pose2& from, const Pose2& to, double radius);

}  // namespace headland
