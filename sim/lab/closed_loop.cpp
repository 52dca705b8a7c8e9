// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/closed_loop.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "local_planner/outline.hpp"
#include "sim/lab/run/plan_driver.hpp"
#include "sim/lab/run/run_metrics.hpp"

namespace headland {
namespace {

constexpr double kProgressPeriod = 1.0;  // simulated [s]
constexpr double kAgentPeriod = 0.5;     // of FleetRun::agents [s]

}  // namespace

std::vector<int> trace_ticks(const std::vector<TraceRow>& trace, double period) {
  std::vector<int> ticks;
  double next = 0.0;
  for (int i = 0; i < static_cast<int>(trace.size()); ++i) {
    const double t = trace[static_cast<std::size_t>(i)].t_s;
    if (i > 0 && i + 1 < static_cast<int>(trace.size()) && t < next) continue;
    ticks.push_back(i);
    next = t + period - 1e-9;
  }
  return ticks;
}

std::vector<FleetTick> fleet_ticks(const FleetRun& run, double period) {
  std::vector<FleetTick> ticks;
  for (std::size_t v = 0; v < run.vehicles.size(); ++v) {
    for (const int tick : trace_ticks(run.vehicles[v].trace, period)) {
      ticks.push_back({v, static_cast<std::size_t>(tick)});
    }
  }
  const auto time = [&run](const FleetTick& t) {
    return run.vehicles[t.vehicle].trace[t.tick].t_s;
  };
  std::stable_sort(ticks.begin(), ticks.end(),
                   [&](const FleetTick& a, const FleetTick& b) { return time(a) < time(b); });
  return ticks;
}

namespace {

// The crowd of a run, and what vehicles keep off when they leave their paths.
struct Surroundings {
  Crowd crowd;
  ClearanceMap obstacles;
};

Result<std::optional<Surroundings>> surroundings(const std::vector<VehiclePlan>& plans,
                                                 const Farm& farm, const SimulationConfig& config) {
  if (!config.agents.anyone()) return std::nullopt;
  std::vector<Point2> starts;
  for (const VehiclePlan& plan : plans) starts.push_back(plan.start.position());
  auto crowd = make_crowd(config.agents, farm, starts, config.seed);
  if (!crowd) return tl::unexpected<Error>(crowd.error());
  return Surroundings{std::move(*crowd), obstacles_of(farm)};
}

CrowdRobot body_of(const PlanDriver& driver, double share) {
  const OutlineDisc disc(driver.vehicle().footprint);
  const VehicleState& truth = driver.truth();
  return {disc.centre(truth.pose), truth.speed * truth.pose.heading(), disc.radius, share};
}

}  // namespace

Result<FleetRun> drive_fleet(const std::vector<VehiclePlan>& plans,
                             const std::vector<Visit>& visits, const Farm& farm,
                             const Ground& ground, const SimulationConfig& config,
                             const RunHooks& hooks) {
  auto around = surroundings(plans, farm, config);
  if (!around) return tl::unexpected<Error>(around.error());
  std::optional<Surroundings>& others = *around;
  PredictorFactory predictor;
  if (others) {
    auto factory = predictor_factory(config.local.planners, hooks.folder);
    if (!factory) return tl::unexpected<Error>(factory.error());
    predictor = std::move(*factory);
  }
  std::optional<LidarScene> scene;
  const bool perceives = std::any_of(plans.begin(), plans.end(), [](const VehiclePlan& plan) {
    return plan.vehicle.lidar.has_value();
  });
  if (config.perception.enabled && perceives) {
    scene = LidarScene::orchard(farm, ground, plants_of(config.perception.crop), config.seed);
  }
  ChargerSlots slots(farm);
  std::vector<PlanDriver> drivers;
  drivers.reserve(plans.size());
  double total = 0.0;
  for (std::size_t v = 0; v < plans.size(); ++v) {
    drivers.emplace_back(static_cast<int>(v), plans[v], visits, farm, ground, config, slots,
                         others ? &others->obstacles : nullptr, predictor,
                         scene ? &*scene : nullptr, hooks);
    total += drivers.back().total_length();
  }
  const auto all_done = [&] {
    return std::all_of(drivers.begin(), drivers.end(),
                       [](const PlanDriver& d) { return d.done(); });
  };
  FleetRun run;
  double next_progress = 0.0;
  double next_frame = 0.0;
  for (long tick = 1; !all_done(); ++tick) {
    const double time = static_cast<double>(tick) * config.step_s;
    std::vector<CrowdRobot> bodies;
    if (others) {
      for (const PlanDriver& driver : drivers) {
        bodies.push_back(body_of(driver, config.agents.robot_share_ratio));
      }
    }
    const auto agents = [&] { return others ? others->crowd.agents() : std::span<const Agent>{}; };
    for (PlanDriver& driver : drivers) driver.step(time, agents());
    if (others) {
      others->crowd.step(config.step_s, bodies);
      for (PlanDriver& driver : drivers) driver.count(agents());
      if (time >= next_frame) {
        next_frame += kAgentPeriod;
        run.agents.push_back({time, {agents().begin(), agents().end()}});
      }
    }
    if (hooks.stop && hooks.stop()) {
      for (PlanDriver& driver : drivers) driver.stop(time);
    }
    if (!hooks.progress || time < next_progress) continue;
    next_progress += kProgressPeriod;
    double driven = 0.0;
    for (const PlanDriver& driver : drivers) driven += driver.driven();
    hooks.progress(driven / std::max(total, 1.0), time);
  }
  for (PlanDriver& driver : drivers) run.vehicles.push_back(driver.finish());
  for (Run& one : run.vehicles) one.metrics.tracking = fleet_tracking({&one, 1});
  run.metrics = fleet_metrics(plans, run.vehicles);
  return run;
}

}  // namespace headland
