// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/curve.hpp"

namespace headland {

/// The shortest path of bounded curvature with reversing (Reeds and Shepp 1990). Same guarantees as
/// shortest_dubins.
/// @param radius Minimum turning radius [m], > 0 (not checked).
Curve shortest_reeds_shepp(const Pose2& from, const Pose2& to, double radius);

/// Its length [m] alone.
double reeds_shepp_length(const Pose2& from, const Pose2& to, double radius);

}  // namespace headland
