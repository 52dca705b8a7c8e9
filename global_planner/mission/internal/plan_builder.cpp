// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/internal/plan_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace headland::mission {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The state of charge along a tour under construction.
class TourBuilder {
 public:
  TourBuilder(const Mission& mission, const Transitions& transitions)
      : mission_(mission), transitions_(transitions) {
    const MissionVehicle& vehicle = mission.vehicles.front();
    plan_.id = vehicle.id;
    plan_.vehicle = vehicle.vehicle;
    plan_.start_soc = vehicle.soc;
    plan_.min_soc = vehicle.soc;
    soc_ = vehicle.soc;
    plan_.stages.emplace_back();
  }

  void add_way(int from, int to) {
    const Path path = transitions_.path(from, to);
    if (path.empty()) return;  // two sites at the same pose
    add_leg(transitions_.kind(from, to),
            transitions_.site(from).name + " to " + transitions_.site(to).name, path,
            transitions_.cost(from, to));
  }

  void add_row(const RowVisit& visit) {
    const Row& row = mission_.rows[static_cast<std::size_t>(visit.row)].row;
    const Path path = row_path(row, visit.entry, plan_.vehicle.turning_radius());
    add_leg(LegKind::kRow, row.id, path, drive_cost(plan_.vehicle, LegKind::kRow, path.length()));
  }

  void add_charge(int charger_index) {
    const Charger& charger = mission_.farm.chargers[static_cast<std::size_t>(charger_index)];
    PlanLeg leg{LegKind::kCharge, charger.id, {}, 1.0, 0};
    leg.cost.duration_s = (1.0 - soc_) * plan_.vehicle.battery.capacity_j() / charger.power_w;
    soc_ = 1.0;
    plan_.stages.back().charge_leg = static_cast<int>(plan_.legs.size());
    plan_.legs.push_back(leg);
    plan_.stages.emplace_back();
  }

  VehiclePlan finish() {
    if (plan_.stages.back().path.empty() && plan_.stages.size() > 1) plan_.stages.pop_back();
    return std::move(plan_);
  }

 private:
  void add_leg(LegKind kind, const std::string& id, const Path& path, const DriveCost& cost) {
    soc_ -= cost.energy_j / plan_.vehicle.battery.capacity_j();
    plan_.energy_j += cost.energy_j;
    plan_.min_soc = std::min(plan_.min_soc, soc_);
    plan_.stages.back().path.append(path, static_cast<int>(plan_.legs.size()));
    plan_.legs.push_back({kind, id, cost, soc_, static_cast<int>(path.segments().size()) - 1});
  }

  const Mission& mission_;
  const Transitions& transitions_;
  VehiclePlan plan_;
  double soc_ = 1.0;
};

}  // namespace

double forced_detours(const Mission& mission, const Transitions& transitions,
                      const SiteIndex& sites, double tour_bound) {
  const MissionVehicle& vehicle = mission.vehicles.front();
  const Battery& battery = vehicle.vehicle.battery;
  double energy = 0.0;
  for (const MissionRow& row : mission.rows) {
    energy += drive_cost(vehicle.vehicle, LegKind::kRow, length(row.row.line)).energy_j;
  }
  // Only where energy is the objective does the tour's bound speak of energy.
  if (mission.config.objective == Objective::kEnergy) energy += tour_bound;
  const double capacity = battery.capacity_j();
  const double first = (vehicle.soc - battery.reserve_soc) * capacity;
  const double per_charge = (1.0 - battery.reserve_soc) * capacity;
  const double stops = std::max(0.0, std::ceil((energy - first) / per_charge - 1e-9));
  if (stops == 0.0 || sites.chargers == 0) return 0.0;

  // Smallest extra of going from any row end (or the start) to any other by way of a charger.
  const Eigen::MatrixXd cost = transitions.matrix();
  double detour = kInfinity;
  for (int c = 0; c < sites.chargers; ++c) {
    for (int from = 0; from <= sites.start(); ++from) {
      for (int to = 0; to <= sites.finish(); ++to) {
        if (to == sites.start() || from == to || (to / 2 == from / 2 && to < sites.start()))
          continue;
        const double extra =
            cost(from, sites.charger(c)) + cost(sites.charger(c), to) - cost(from, to);
        if (extra < detour) detour = extra;
      }
    }
  }
  const double charging =
      mission.config.objective == Objective::kTime && energy > first
          ? (energy - first) /
                std::max_element(
                    mission.farm.chargers.begin(), mission.farm.chargers.end(),
                    [](const Charger& a, const Charger& b) { return a.power_w < b.power_w; })
                    ->power_w
          : 0.0;
  return std::isfinite(detour) ? stops * std::max(0.0, detour) + charging : 0.0;
}

VehiclePlan build_vehicle_plan(const Mission& mission, const Transitions& transitions,
                               const SiteIndex& sites, const std::vector<RowVisit>& visits,
                               const std::vector<ChargeStop>& stops) {
  TourBuilder tour(mission, transitions);
  auto stop = stops.begin();
  for (std::size_t gap = 0; gap <= visits.size(); ++gap) {
    const int from = gap == 0 ? sites.start() : visits[gap - 1].exit_end();
    const int to = gap == visits.size() ? sites.finish() : visits[gap].entry_end();
    if (stop != stops.end() && stop->gap == static_cast<int>(gap)) {
      tour.add_way(from, sites.charger(stop->charger));
      tour.add_charge(stop->charger);
      tour.add_way(sites.charger(stop->charger), to);
      ++stop;
    } else {
      tour.add_way(from, to);
    }
    if (gap < visits.size()) tour.add_row(visits[gap]);
  }
  return tour.finish();
}

void add_totals(MissionPlan& plan) {
  for (const VehiclePlan& vehicle : plan.vehicles) {
    double duration = 0.0;
    for (const PlanLeg& leg : vehicle.legs) {
      duration += leg.cost.duration_s;
      switch (leg.kind) {
        case LegKind::kRow:
          plan.work_m += leg.cost.length_m;
          break;
        case LegKind::kTurn:
          plan.turn_m += leg.cost.length_m;
          break;
        case LegKind::kCharge:
          ++plan.charge_stops;
          break;
        case LegKind::kTransit:
        case LegKind::kTask:
          plan.transit_m += leg.cost.length_m;
          break;
      }
    }
    plan.makespan_s = std::max(plan.makespan_s, duration);
  }
}

Error with_row_name(Error error, const Mission& mission) {
  // "row 12 ..." -> "row 2019-a-3/r4 ..."
  const std::string word = "row ";
  const auto at = error.what.find(word);
  if (at == std::string::npos) return error;
  const auto begin = at + word.size();
  auto end = begin;
  while (end < error.what.size() && std::isdigit(static_cast<unsigned char>(error.what[end])) != 0)
    ++end;
  if (end == begin) return error;
  const auto index = static_cast<std::size_t>(std::stoi(error.what.substr(begin, end - begin)));
  if (index < mission.rows.size())
    error.what.replace(begin, end - begin, mission.rows[index].row.id);
  return error;
}

}  // namespace headland::mission
