// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "global_planner/roadmap/internal/way_search.hpp"

namespace headland::internal {

/// Joins goals to the nearest nodes of the roadmap, and to the nearest other goals: by the
/// roadmap's curve, or where too few of those fit by Dubins curves, which turn on the spot as far
/// as a vehicle can.
GoalLinks link_goals(const std::vector<Site>& goals, const RoadGraph& graph,
                     const TrackMaker& tracks, double margin);

}  // namespace headland::internal
