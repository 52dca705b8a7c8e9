// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "apps/command.hpp"
#include "sim/lab/closed_loop.hpp"

namespace headland::apps {

/// metrics.json (DESIGN section 5).
std::string metrics_json(const FleetRun& run, const std::vector<VehiclePlan>& plans,
                         double real_time_factor, const Stamp& stamp);
/// trace.csv: a line every `period` [s] for each vehicle, by time. Shortest decimals that read back
/// to the same bits.
std::string trace_csv(const FleetRun& run, const std::vector<VehiclePlan>& plans, double period);
/// A few lines for a person.
std::string run_text(const FleetRun& run, double real_time_factor);

}  // namespace headland::apps
