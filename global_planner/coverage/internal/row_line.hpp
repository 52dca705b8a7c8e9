// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/polygon.hpp"

namespace headland::coverage {

/// The fewest of a line's points such that none of the others lies farther than `tolerance` [m]
/// from the line through them (Douglas and Peucker 1973). Same points in both directions.
Polyline simplified(const Polyline& line, double tolerance);

/// What a survey leaves of a straight row's wiggles [m].
inline constexpr double kSurveyTolerance = 0.05;

}  // namespace headland::coverage
