// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/mission_plan.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "global_planner/coverage/transitions.hpp"
#include "global_planner/mission/internal/plan_builder.hpp"
#include "global_planner/tour/recharge.hpp"
#include "global_planner/tour/row_tour.hpp"

namespace headland {
namespace {

using mission::SiteIndex;

std::vector<Site> stops_of(const Mission& mission) {
  std::vector<Site> stops;
  const MissionVehicle& vehicle = mission.vehicles.front();
  stops.push_back({vehicle.start, vehicle.start, "start"});
  stops.push_back({vehicle.finish, vehicle.finish, "finish"});
  for (const Charger& charger : mission.farm.chargers) {
    stops.push_back({charger.pose, charger.pose, "charger " + charger.id});
  }
  return stops;
}

RowTourProblem tour_problem(const Transitions& transitions, const SiteIndex& sites) {
  const Eigen::MatrixXd all = transitions.matrix();
  const int ends = 2 * sites.rows;
  return {all.topLeftCorner(ends, ends), all.row(sites.start()).head(ends),
          all.col(sites.finish()).head(ends)};
}

// The recharge problem of one order of rows: straight on, or by way of a charger, in every gap.
RechargeProblem recharge_problem(const Mission& mission, const Transitions& transitions,
                                 const SiteIndex& sites, const std::vector<RowVisit>& visits) {
  const std::vector<DriveCost> rows = mission::row_costs(mission);
  const MissionVehicle& vehicle = mission.vehicles.front();
  const Battery& battery = vehicle.vehicle.battery;
  const Objective objective = mission.config.objective;
  const double margin = 1.0 + mission.config.planner.energy_margin_ratio;
  const auto way = [&](int from, int to) {
    const DriveCost cost = transitions.cost(from, to);
    return RechargeProblem::Way{cost.value(objective), margin * cost.energy_j};
  };
  RechargeProblem problem;
  problem.capacity_j = battery.capacity_j();
  problem.start_energy_j = vehicle.soc * battery.capacity_j();
  problem.reserve_j = battery.reserve_soc * battery.capacity_j();
  for (const Charger& charger : mission.farm.chargers) {
    problem.stop_cost_per_j.push_back(
        objective == Objective::kTime ? 1.0 / charger.curve.max_power() : 0.0);
  }
  for (std::size_t gap = 0; gap <= visits.size(); ++gap) {
    const int from = gap == 0 ? sites.start() : visits[gap - 1].exit_end();
    const int to = gap == visits.size() ? sites.finish() : visits[gap].entry_end();
    RechargeProblem::Gap ways{way(from, to), {}, {}};
    for (int c = 0; c < sites.chargers; ++c) {
      ways.to_charger.push_back(way(from, sites.charger(c)));
      ways.from_charger.push_back(way(sites.charger(c), to));
    }
    problem.gaps.push_back(std::move(ways));
    if (gap == visits.size()) break;
    problem.item_energy_j.push_back(margin *
                                    rows[static_cast<std::size_t>(visits[gap].row)].energy_j);
  }
  return problem;
}

// Cost of all rows in the objective's unit: the same in every plan.
double work_value(const Mission& mission) {
  double value = 0.0;
  for (const DriveCost& cost : mission::row_costs(mission)) {
    value += cost.value(mission.config.objective);
  }
  return value;
}

std::vector<RowVisit> reversed_order(const std::vector<RowVisit>& visits) {
  std::vector<RowVisit> reversed(visits.rbegin(), visits.rend());
  for (RowVisit& visit : reversed) visit.entry = 1 - visit.entry;
  return reversed;
}

struct Order {
  std::vector<RowVisit> visits;
  RechargePlan recharges;
};

// The tour's order with its best recharge stops; driven the other way round if that is cheaper.
Result<Order> charged_order(const Mission& mission, const Transitions& transitions,
                            const SiteIndex& sites, const RowTour& tour) {
  const auto charged = [&](std::vector<RowVisit> visits) -> Result<Order> {
    auto plan = plan_recharges(recharge_problem(mission, transitions, sites, visits));
    if (!plan) {
      std::vector<RowRef> in_order;
      for (const RowVisit& visit : visits) {
        in_order.push_back(mission.rows[static_cast<std::size_t>(visit.row)]);
      }
      return tl::unexpected<Error>(mission::with_row_name(plan.error(), "item", mission, in_order));
    }
    return Order{std::move(visits), std::move(*plan)};
  };
  auto forwards = charged(tour.visits);
  auto backwards = charged(reversed_order(tour.visits));
  if (!forwards || (backwards && backwards->recharges.cost < forwards->recharges.cost)) {
    if (backwards) return backwards;
  }
  return forwards;
}

// No plan is cheaper than the rows, the cheapest order, and the detours that the battery forces.
double plan_lower_bound(const Mission& mission, const Transitions& transitions,
                        const SiteIndex& sites, const RowTour& tour) {
  return work_value(mission) + tour.lower_bound +
         mission::forced_detours(mission, transitions, sites, tour.lower_bound);
}

}  // namespace

Result<MissionPlan> plan_mission(const Mission& mission) {
  const MissionVehicle& vehicle = mission.vehicles.front();
  const PlannerConfig& config = mission.config.planner;
  if (auto error = mission::check_standing_places(mission)) {
    return tl::unexpected<Error>(std::move(*error));
  }
  const SiteIndex sites{static_cast<int>(mission.rows.size()),
                        static_cast<int>(mission.farm.chargers.size())};
  TransitionOptions options;
  options.objective = mission.config.objective;
  options.margin_m = config.margin_m;
  options.fishtail = config.fishtail;
  options.reeds_shepp = config.reeds_shepp;
  const auto transitions =
      Transitions::build(mission.farm, mission.rows, stops_of(mission), vehicle.vehicle, options);
  if (!transitions) return tl::unexpected<Error>(transitions.error());

  const auto tour = solve_row_tour(tour_problem(*transitions, sites),
                                   {config.seed, config.iterations, config.exact_up_to_rows});
  if (!tour)
    return tl::unexpected<Error>(
        mission::with_row_name(tour.error(), "row", mission, mission.rows));
  const auto order = charged_order(mission, *transitions, sites, *tour);
  if (!order) return tl::unexpected<Error>(order.error());

  MissionPlan plan;
  plan.objective = mission.config.objective;
  plan.value = work_value(mission) + order->recharges.cost;
  plan.lower_bound = std::min(plan.value, plan_lower_bound(mission, *transitions, sites, *tour));
  plan.vehicles.push_back(mission::build_vehicle_plan(mission, *transitions, sites, order->visits,
                                                      order->recharges.stops));
  mission::add_totals(plan);
  return plan;
}

}  // namespace headland
