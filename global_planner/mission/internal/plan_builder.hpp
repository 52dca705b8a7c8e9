// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "global_planner/mission/internal/tour_model.hpp"
#include "global_planner/mission/mission_plan.hpp"

namespace headland::mission {

/// The plan that a solution of the model's tour problem stands for: legs, paths, states of charge
/// by the energy model as it is (the solver's include the margin), times as the solver scheduled
/// them.
MissionPlan build_plan(const TourModel& model, const TourSolution& solution);

}  // namespace headland::mission
