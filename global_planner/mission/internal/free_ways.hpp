// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.hpp"
#include "global_planner/coverage/transitions.hpp"
#include "global_planner/mission/mission_config.hpp"

namespace headland::mission {

/// Offers ways over open ground, where the farm has free parcels: the roadmap's lowest-cost ways
/// between places, chargers and row ends (003, III-A), and where those still are a detour, what
/// Hybrid A* finds. Transitions keep the cheaper of these and their own.
Result<void> offer_free_ways(const Mission& mission, const Vehicle& vehicle,
                             Transitions& transitions);

}  // namespace headland::mission
