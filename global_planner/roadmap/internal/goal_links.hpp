// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "global_planner/roadmap/internal/way_search.hpp"

namespace headland::internal {

/// Joins goals to the nearest nodes of the roadmap, and to the nearest other goals, by clothoids;
/// and by Dubins curves, which turn round where no clothoid can: between goals only if no clothoid
/// serves.
GoalLinks link_goals(const std::vector<Site>& goals, const RoadGraph& graph,
                     const TrackMaker& tracks, double margin);

}  // namespace headland::internal
