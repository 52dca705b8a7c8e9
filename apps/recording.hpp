// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/world/farm.hpp"
#include "sim/lab/closed_loop.hpp"

namespace headland::apps {

/// run.mcap: the drives every `period` [s] as Foxglove's PoseInFrame and LocationFix, the planned
/// paths as PosesInFrame, and the tracking states as JSON; topics begin with the vehicle's id.
std::string run_mcap(const FleetRun& run, const std::vector<VehiclePlan>& plans, const Farm& farm,
                     double period);

}  // namespace headland::apps
