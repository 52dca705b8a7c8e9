// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/mission_plan.hpp"

#include "global_planner/mission/internal/plan_builder.hpp"
#include "global_planner/mission/internal/tour_model.hpp"
#include "global_planner/tour/tour_solver.hpp"

namespace headland {
namespace {

Error in_the_missions_words(Error error, const mission::TourModel& model) {
  if (error.code == ErrorCode::kNoPath) {
    error.remedy =
        "join it by a road or gate that is wide enough, use a smaller vehicle, or leave it "
        "out";
  }
  if (error.code == ErrorCode::kTaskDoesNotFit) {
    error.remedy =
        "allow_dropping: true leaves the least valuable out; or more charge, chargers, time "
        "(shift_s, latest_s) or vehicles";
  }
  error.what = model.named(error.what, true);
  return error;
}

}  // namespace

Result<MissionPlan> plan_mission(const Mission& mission, const PlanningHooks& hooks) {
  const auto model = mission::TourModel::build(mission);
  if (!model) return tl::unexpected<Error>(model.error());
  TourOptions options;
  options.seed = mission.config.planner.seed;
  options.iterations = mission.config.planner.iterations;
  options.exact_up_to_tasks = mission.config.planner.exact_up_to_tasks;
  options.stop = hooks.stop;
  options.progress = hooks.progress;
  const auto solution = solve_tour(model->problem(), options);
  if (!solution) return tl::unexpected<Error>(in_the_missions_words(solution.error(), *model));
  return mission::build_plan(*model, *solution);
}

}  // namespace headland
