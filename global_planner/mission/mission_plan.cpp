// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/mission_plan.hpp"

#include <cctype>
#include <string>

#include "global_planner/mission/internal/plan_builder.hpp"
#include "global_planner/mission/internal/tour_model.hpp"
#include "global_planner/tour/tour_solver.hpp"

namespace headland {
namespace {

// The solver speaks of "task 4"; this puts the row's or place's name there.
Error with_task_name(Error error, const mission::TourModel& model) {
  static constexpr std::string_view kWord = "task ";
  const auto at = error.what.find(kWord);
  if (at == std::string::npos) return error;
  const auto begin = at + kWord.size();
  auto end = begin;
  while (end < error.what.size() && std::isdigit(static_cast<unsigned char>(error.what[end]))) {
    ++end;
  }
  if (end == begin || end - begin > 7) return error;
  const int task = std::stoi(error.what.substr(begin, end - begin));
  if (error.code == ErrorCode::kNoPath) {
    error.remedy = "join it by a road or gate that is wide enough, use a smaller vehicle, or leave it "
                   "out";
  }
  if (task < static_cast<int>(model.tasks().size())) {
    error.what.replace(at, end - at, model.task_name(task));
  }
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
  if (!solution) return tl::unexpected<Error>(with_task_name(solution.error(), *model));
  return mission::build_plan(*model, *solution);
}

}  // namespace headland
