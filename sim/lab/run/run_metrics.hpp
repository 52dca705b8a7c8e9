// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "sim/lab/closed_loop.hpp"

namespace headland {

/// Counts rows, and those of which all parts are done, by whichever vehicle. What was planned and
/// is no leg of what was driven is not done.
void count_rows(std::span<const VehiclePlan> plans, std::span<const Run> runs, RunMetrics& metrics);

/// Tracking errors of several vehicles as one sequence; legs numbered on. Only where the path is
/// followed.
TrackingMetrics fleet_tracking(std::span<const Run> runs);

/// Sums, and the worst of all.
RunMetrics fleet_metrics(const std::vector<VehiclePlan>& plans, const std::vector<Run>& runs);

}  // namespace headland
