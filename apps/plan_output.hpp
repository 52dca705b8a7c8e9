// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "apps/command.hpp"
#include "core/world/farm.hpp"
#include "global_planner/mission/mission_plan.hpp"

namespace headland::apps {

/// summary.json (DESIGN section 5).
std::string summary_json(const MissionPlan& plan, double planning_s, const Stamp& stamp);

/// plan.geojson: the legs in WGS84, in driving order, each with its kind, energy and state of
/// charge.
std::string plan_geojson(const MissionPlan& plan, const Farm& farm, const Stamp& stamp);

/// A few lines for a person, on the terminal.
std::string plan_text(const MissionPlan& plan, double planning_s);

/// "1 h 23 min", "4 min 05 s", "12 s".
std::string duration_text(double seconds);

}  // namespace headland::apps
