// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/planned_mission.hpp"
#include "apps/report.hpp"
#include "apps/study_output.hpp"
#include "sim/lab/closed_loop.hpp"

namespace headland::apps {

/// The report of a plan: the farm and its relief, the planned paths, state of charge and speed over
/// distance, legs, and why they are there.
Report plan_report(const PlannedMission& planned);
/// The report of a drive: the plan's, with the driven paths, errors and steering.
Report run_report(const PlannedMission& planned, const FleetRun& run, double real_time_factor);
/// The report of a study: its cells as a table, its tables and plots.
Report study_report(const FinishedStudy& study);

}  // namespace headland::apps
