// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/command.hpp"
#include "apps/run_config.hpp"
#include "global_planner/mission/mission_plan.hpp"

namespace headland::apps {

/// A mission file, read and planned: what `plan` ends with and `run` starts from.
struct PlannedMission {
  RunConfig config;
  Stamp stamp;  ///< with the planner's seed
  Mission mission;
  MissionPlan plan;
  double planning_s = 0.0;
};

Result<PlannedMission> plan_from_file(const CommonOptions& options);

}  // namespace headland::apps
