// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/internal/plan_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "core/geometry/region.hpp"

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
    const RowRef ref = mission_.rows[static_cast<std::size_t>(visit.row)];
    const Path path = row_path(mission_.farm.row(ref), visit.entry, plan_.vehicle.turning_radius());
    add_leg(LegKind::kRow, mission_.farm.row_name(ref), path,
            drive_cost(plan_.vehicle, LegKind::kRow, path.length()));
  }

  void add_charge(int charger_index) {
    const Charger& charger = mission_.farm.chargers[static_cast<std::size_t>(charger_index)];
    PlanLeg leg{LegKind::kCharge, charger.id, {}, 1.0, 0};
    leg.cost.duration_s =
        (1.0 - soc_) * plan_.vehicle.battery.capacity_j() / charger.curve.max_power();
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

// Smallest extra of going from anywhere to anywhere else by way of a charger.
double least_detour(const Eigen::MatrixXd& cost, const SiteIndex& sites) {
  double least = kInfinity;
  const int ends = 2 * sites.rows;
  for (int c = 0; c < sites.chargers; ++c) {
    const int charger = sites.charger(c);
    for (int from = 0; from < ends + 1; ++from) {
      for (int to = 0; to < ends + 2; ++to) {
        const bool same_row = from < ends && to < ends && from / 2 == to / 2;
        if (to == sites.start() || same_row) continue;
        const double by_way = cost(from, charger) + cost(charger, to);
        if (std::isfinite(by_way)) least = std::min(least, by_way - cost(from, to));
      }
    }
  }
  return least;
}

}  // namespace

std::optional<Error> check_standing_places(const Mission& mission) {
  constexpr double kSpacing = 0.25;  // of the outlines along a row [m]
  const Region drivable(drivable_area(mission.farm));
  const MissionVehicle& vehicle = mission.vehicles.front();
  const auto inside = [&](const Pose2& pose) {
    return drivable.contains(pose, vehicle.vehicle.footprint);
  };
  const auto place_error = [](const std::string& place, const Pose2& pose, const std::string& key) {
    return Error{
        ErrorCode::kNoPath,
        fmt::format("{} at ({:.1f}, {:.1f}): the vehicle does not fit into the drivable area "
                    "there",
                    place, pose.x, pose.y),
        "put it on a road, headland or free parcel, clear of keep-outs",
        {{}, 0, key}};
  };
  if (!inside(vehicle.start)) return place_error("the start", vehicle.start, "vehicles.0.start");
  if (!inside(vehicle.finish))
    return place_error("the finish", vehicle.finish, "vehicles.0.finish");
  for (const RowRef ref : mission.rows) {
    const Path path = row_path(mission.farm.row(ref), 0, vehicle.vehicle.turning_radius());
    for (const PathSample& sample : path.sample(kSpacing)) {
      // Either way round: the row may be driven in both directions.
      if (inside(sample.pose) || inside(reversed(sample.pose))) continue;
      return Error{
          ErrorCode::kNoPath,
          fmt::format("row {} at ({:.1f}, {:.1f}): the vehicle's outline leaves the drivable "
                      "area or enters a keep-out",
                      mission.farm.row_name(ref), sample.pose.x, sample.pose.y),
          "leave the row out (tasks.rows), or correct keep-out, parcel or row",
          {}};
    }
  }
  return std::nullopt;
}

double forced_detours(const Mission& mission, const Transitions& transitions,
                      const SiteIndex& sites, double tour_bound) {
  if (sites.chargers == 0) return 0.0;
  const MissionVehicle& vehicle = mission.vehicles.front();
  const Battery& battery = vehicle.vehicle.battery;
  RechargeBound bound;
  for (const DriveCost& cost : row_costs(mission)) bound.energy_j += cost.energy_j;
  // Only where energy is the objective does the tour's bound speak of energy.
  if (mission.config.objective == Objective::kEnergy) bound.energy_j += tour_bound;
  bound.start_j = (vehicle.soc - battery.reserve_soc) * battery.capacity_j();
  bound.per_charge_j = (1.0 - battery.reserve_soc) * battery.capacity_j();
  if (min_charge_stops(bound) <= 0) return 0.0;
  bound.detour_cost = std::max(0.0, least_detour(transitions.matrix(), sites));
  if (!std::isfinite(bound.detour_cost)) return 0.0;
  double charging = 0.0;
  if (mission.config.objective == Objective::kTime) {
    double power = 0.0;
    for (const Charger& charger : mission.farm.chargers)
      power = std::max(power, charger.curve.max_power());
    charging = (bound.energy_j - bound.start_j) / power;
  }
  return recharge_lower_bound(bound) + charging;
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

std::vector<DriveCost> row_costs(const Mission& mission) {
  const Vehicle& vehicle = mission.vehicles.front().vehicle;
  std::vector<DriveCost> costs;
  for (const RowRef ref : mission.rows) {
    const Path path = row_path(mission.farm.row(ref), 0, vehicle.turning_radius());
    costs.push_back(drive_cost(vehicle, LegKind::kRow, path.length()));
  }
  return costs;
}

Error with_row_name(Error error, const std::string& word, const Mission& mission,
                    const std::vector<RowRef>& numbered) {
  const auto at = error.what.find(word + " ");
  if (at == std::string::npos) return error;
  const auto begin = at + word.size() + 1;
  const auto end = error.what.find_first_not_of("0123456789", begin);
  if (end == begin) return error;
  if (end != std::string::npos && end - begin > 6) return error;
  const auto index = static_cast<std::size_t>(std::stoi(error.what.substr(begin)));
  if (index < numbered.size()) {
    error.what.replace(at, end - at, "row " + mission.farm.row_name(numbered[index]));
  }
  return error;
}

}  // namespace headland::mission
