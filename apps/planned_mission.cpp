// SPDX-License-Identifier: Apache-2.0
#include "apps/planned_mission.hpp"

#include <chrono>

#include "apps/interrupt.hpp"

namespace headland::apps {
namespace {

// Errors that speak of keys of the mission, without a file yet, get its name.
Error in_file(Error error, const std::string& file) {
  if (error.where.file.empty()) error.where.file = file;
  return error;
}

// Ctrl-C ends the search with the best plan found.
Result<MissionPlan> plan_with_progress(const Mission& mission) {
  ProgressBar bar("planning");
  const InterruptGuard guard;
  PlanningHooks hooks;
  hooks.stop = InterruptGuard::interrupted;
  hooks.progress = [&bar](double fraction, double) { bar.update(fraction); };
  return plan_mission(mission, hooks);
}

}  // namespace

Result<PlannedMission> plan_from_file(const CommonOptions& options) {
  const auto node = load_with_overrides(options);
  if (!node) return tl::unexpected<Error>(node.error());
  PlannedMission planned;
  if (auto read = config::read_into(*node, planned.config); !read) {
    return tl::unexpected<Error>(read.error());
  }
  planned.stamp = make_stamp(planned.config.mission.planner.seed, config::to_yaml(planned.config));

  const auto begin = std::chrono::steady_clock::now();
  auto mission =
      load_mission(planned.config.mission, std::filesystem::path(options.file).parent_path());
  if (!mission) return tl::unexpected<Error>(in_file(mission.error(), options.file));
  auto plan = plan_with_progress(*mission);
  if (!plan) return tl::unexpected<Error>(in_file(plan.error(), options.file));
  planned.planning_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  planned.mission = std::move(*mission);
  planned.plan = std::move(*plan);
  return planned;
}

}  // namespace headland::apps
