// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/world/farm.hpp"
#include "sim/lab/closed_loop.hpp"

namespace headland::apps {

/// run.mcap: the drive every `period` [s] as Foxglove's PoseInFrame and LocationFix, the planned
/// path as PosesInFrame, and the tracking state as JSON.
std::string run_mcap(const Run& run, const VehiclePlan& plan, const Farm& farm, double period);

}  // namespace headland::apps
