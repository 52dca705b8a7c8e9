// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/rest_of_mission.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace headland {
namespace {

TaskTerms from_now(TaskTerms terms, double time) {
  terms.earliest_s = std::max(0.0, terms.earliest_s - time);
  terms.latest_s -= time;
  return terms;
}

}  // namespace

double spare_energy(const VehiclePlan& plan, const PlanProgress& progress, double soc,
                    double margin_ratio) {
  const Battery& battery = plan.vehicle.battery;
  double left = soc * battery.capacity_j();
  double least = left;
  for (auto i = static_cast<std::size_t>(progress.leg); i < plan.legs.size(); ++i) {
    const PlanLeg& leg = plan.legs[i];
    if (leg.kind == LegKind::kCharge) break;
    const bool under_way = i == static_cast<std::size_t>(progress.leg);
    const double share = under_way ? 1.0 - std::clamp(progress.done_ratio, 0.0, 1.0) : 1.0;
    const double energy = share * leg.cost.energy_j;
    left -= energy > 0.0 ? energy * (1.0 + margin_ratio) : energy;
    least = std::min(least, left);
  }
  return least - battery.reserve_j();
}

Result<RestOfMission> rest_of_mission(const Mission& mission, std::size_t vehicle,
                                      const VehiclePlan& plan, const Standing& standing) {
  RestOfMission answer;
  Mission& rest = answer.mission;
  rest.config = mission.config;
  rest.config.allow_dropping = true;
  rest.farm = mission.farm;
  rest.ground = mission.ground;
  MissionVehicle own = mission.vehicles[vehicle];
  own.start = standing.pose;
  own.soc = standing.soc;
  own.shift_s -= standing.time_s;
  rest.vehicles = {own};

  std::set<std::string> rows;
  for (auto i = static_cast<std::size_t>(standing.next_leg); i < plan.legs.size(); ++i) {
    const PlanLeg& leg = plan.legs[i];
    if (leg.kind == LegKind::kRow) rows.insert(leg.id);
    if (leg.visit < 0) continue;
    Visit visit = mission.visits[static_cast<std::size_t>(leg.visit)];
    visit.terms = from_now(visit.terms, standing.time_s);
    rest.visits.push_back(visit);
    answer.visits.push_back(leg.visit);
  }
  for (std::size_t i = 0; i < mission.rows.size(); ++i) {
    if (!rows.contains(mission.farm.row_name(mission.rows[i]))) continue;
    rest.rows.push_back(mission.rows[i]);
    rest.row_terms.push_back(from_now(mission.row_terms[i], standing.time_s));
  }
  if (rest.rows.empty() && rest.visits.empty()) {
    return tl::unexpected<Error>({ErrorCode::kNoRows,
                                  fmt::format("vehicle '{}' has no task left", own.id),
                                  "it goes on to its finish",
                                  {}});
  }
  return answer;
}

Result<VehiclePlan> replan(const Mission& mission, std::size_t vehicle, const VehiclePlan& plan,
                           const Standing& standing, const PlanningHooks& hooks) {
  const auto rest = rest_of_mission(mission, vehicle, plan, standing);
  if (!rest) return tl::unexpected<Error>(rest.error());
  auto found = plan_mission(rest->mission, hooks);
  if (!found) return tl::unexpected<Error>(found.error());
  VehiclePlan answer = std::move(found->vehicles.front());
  for (PlanLeg& leg : answer.legs) {
    if (leg.visit >= 0) leg.visit = rest->visits[static_cast<std::size_t>(leg.visit)];
  }
  return answer;
}

}  // namespace headland
