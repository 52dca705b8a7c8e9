// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include "apps/command.hpp"
#include "apps/interrupt.hpp"
#include "apps/output_files.hpp"
#include "apps/plan_output.hpp"
#include "apps/planned_mission.hpp"
#include "apps/recording.hpp"
#include "apps/report_content.hpp"
#include "apps/run_output.hpp"
#include "core/base/clock.hpp"

namespace headland::apps {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// Ctrl-C ends the run; what was driven is reported.
Result<FleetRun> drive(const PlannedMission& planned, const std::filesystem::path& folder,
                       double realtime) {
  ProgressBar bar("driving");
  const InterruptGuard guard;
  const auto begin = Clock::now();
  RunHooks hooks;
  hooks.progress = [&](double fraction, double time_s) {
    bar.update(fraction);
    if (realtime <= 0.0) return;
    const double ahead = time_s / realtime - seconds_since(begin);
    if (ahead > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(ahead));
  };
  const Mission& mission = planned.mission;
  const SteadyClock clock;  // for deadlines, if any are set
  hooks.clock = &clock;
  hooks.stop = InterruptGuard::interrupted;
  hooks.folder = folder;
  hooks.replan = [&](std::size_t vehicle, const VehiclePlan& plan, const Standing& standing) {
    return replan(mission, vehicle, plan, standing);
  };
  return drive_fleet(planned.plan.vehicles, mission.visits, mission.farm, mission.ground,
                     planned.config.simulation, hooks);
}

}  // namespace

int run_command(const CommonOptions& options, double realtime) {
  if (!std::isfinite(realtime)) {
    return report_error(
        {ErrorCode::kOutOfRange, "not a number", "write 0 or more", {"--realtime", 0, ""}},
        options);
  }
  if (auto ready = prepare_output(options.out); !ready) {
    return report_error(ready.error(), options);
  }
  auto planned = plan_from_file(options);
  if (!planned) return report_error(planned.error(), options);
  if (!options.json) fmt::print("{}\n", plan_text(planned->plan, planned->planning_s));
  std::fflush(stdout);
  const auto begin = Clock::now();
  const auto driven = drive(*planned, std::filesystem::path(options.file).parent_path(), realtime);
  if (!driven) return report_error(driven.error(), options);
  const FleetRun& run = *driven;
  for (std::size_t v = 0; v < run.vehicles.size(); ++v) {
    planned->plan.vehicles[v] = run.vehicles[v].driven;
  }
  const double real_time_factor = run.metrics.duration_s / std::max(1e-9, seconds_since(begin));

  const std::string metrics =
      metrics_json(run, planned->plan.vehicles, real_time_factor,
                   make_stamp(planned->config.simulation.seed, planned->stamp.config_yaml));
  const auto written = write_report(
      run_report(*planned, run, real_time_factor), options.out,
      {{"summary.json", summary_json(planned->plan, planned->planning_s, planned->stamp)},
       {"plan.geojson", plan_geojson(planned->plan, planned->mission.farm, planned->stamp)},
       {"metrics.json", metrics},
       {"trace.csv",
        trace_csv(run, planned->plan.vehicles, planned->config.simulation.trace_period_s)},
       {"run.mcap", run_mcap(run, planned->plan.vehicles, planned->mission.farm,
                             planned->config.simulation.trace_period_s)}});
  if (!written) return report_error(written.error(), options);
  if (options.json) {
    fmt::print("{}", metrics);
  } else {
    fmt::print("{}{}", run_text(run, real_time_factor), report_line(options.out));
  }
  return run.metrics.completed ? 0 : 3;
}

}  // namespace headland::apps
