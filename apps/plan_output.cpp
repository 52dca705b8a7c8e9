// SPDX-License-Identifier: Apache-2.0
#include "apps/plan_output.hpp"

#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace headland::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSampleSpacing = 0.5;  // of paths in plan.geojson [m]

// To `decimals` places, as the nearest double of that decimal.
double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

Json leg_json(const PlanLeg& leg) {
  Json json = {{"kind", config::enum_name(leg.kind)},
               {"id", leg.id},
               {"length_m", rounded(leg.cost.length_m, 3)},
               {"energy_j", rounded(leg.cost.energy_j, 1)},
               {"duration_s", rounded(leg.cost.duration_s, 2)},
               {"soc_end", rounded(leg.soc_end, 5)},
               {"begin_s", rounded(leg.begin_s, 2)}};
  if (leg.wait_s > 0.0) json["wait_s"] = rounded(leg.wait_s, 2);
  if (leg.from_m != leg.to_m) {
    json["from_m"] = rounded(leg.from_m, 2);
    json["to_m"] = rounded(leg.to_m, 2);
  }
  return json;
}

double total_energy(const MissionPlan& plan) {
  double energy = 0.0;
  for (const VehiclePlan& vehicle : plan.vehicles) energy += vehicle.energy_j;
  return energy;
}

Json stamp_json(const Stamp& stamp) {
  return {{"version", stamp.version},
          {"seed", stamp.seed},
          {"config_hash", stamp.config_hash},
          {"config_yaml", stamp.config_yaml}};
}

Json leg_coordinates(const Path& path, int leg, const Farm& farm) {
  Json coordinates = Json::array();
  const auto [begin, end] = path.leg_range(leg);
  const int steps = std::max(1, static_cast<int>(std::ceil((end - begin) / kSampleSpacing)));
  for (int i = 0; i <= steps; ++i) {
    const LatLon p =
        farm.frame.to_wgs84(path.at(begin + (end - begin) * i / steps).pose.position());
    coordinates.push_back({rounded(p.lon_deg, 8), rounded(p.lat_deg, 8)});
  }
  return coordinates;
}

std::string gap_text(const MissionPlan& plan) {
  if (plan.status() == PlanStatus::kOptimal) return "proven";
  const double percent = 100.0 * plan.gap_ratio();
  return percent < 0.01 ? "gap below 0.01 %" : fmt::format("gap {:.2f} %", percent);
}

}  // namespace

std::string summary_json(const MissionPlan& plan, double planning_s, const Stamp& stamp) {
  Json document = {{"status", config::enum_name(plan.status())},
                   {"objective", config::enum_name(plan.objective)},
                   {"totals",
                    {{"work_m", rounded(plan.work_m, 3)},
                     {"turn_m", rounded(plan.turn_m, 3)},
                     {"transit_m", rounded(plan.transit_m, 3)},
                     {"energy_j", rounded(total_energy(plan), 1)},
                     {"makespan_s", rounded(plan.makespan_s, 2)},
                     {"charge_stops", plan.charge_stops}}},
                   {"min_margin_j", rounded(plan.min_margin_j, 1)},
                   {"objective_value", plan.value},
                   {"lower_bound", plan.lower_bound},
                   {"gap_ratio", plan.gap_ratio()},
                   {"planning_s", rounded(planning_s, 4)},
                   {"vehicles", Json::array()}};
  for (const VehiclePlan& vehicle : plan.vehicles) {
    Json legs = Json::array();
    for (const PlanLeg& leg : vehicle.legs) legs.push_back(leg_json(leg));
    document["vehicles"].push_back({{"id", vehicle.id},
                                    {"energy_j", rounded(vehicle.energy_j, 1)},
                                    {"min_soc", rounded(vehicle.min_soc, 5)},
                                    {"min_margin_j", rounded(vehicle.min_margin_j, 1)},
                                    {"finish_s", rounded(vehicle.finish_s, 2)},
                                    {"legs", std::move(legs)}});
  }
  document["dropped"] = Json::array();
  for (const DroppedWork& work : plan.dropped) {
    document["dropped"].push_back({{"id", work.id}, {"reason", work.reason}});
  }
  document["why"] = Json::array();
  for (const PlanReason& reason : plan.reasons) {
    Json why = {{"text", reason.text}};
    if (reason.vehicle >= 0) {
      why["vehicle"] = plan.vehicles[static_cast<std::size_t>(reason.vehicle)].id;
      why["leg"] = reason.leg;
    }
    document["why"].push_back(std::move(why));
  }
  document["headland"] = stamp_json(stamp);
  return document.dump(2) + "\n";
}

std::string plan_geojson(const MissionPlan& plan, const Farm& farm, const Stamp& stamp) {
  Json features = Json::array();
  for (const VehiclePlan& vehicle : plan.vehicles) {
    int stage = 0;
    Point2 place = vehicle.start.position();
    for (int i = 0; i < static_cast<int>(vehicle.legs.size()); ++i) {
      const PlanLeg& leg = vehicle.legs[static_cast<std::size_t>(i)];
      Json properties = leg_json(leg);
      properties["vehicle"] = vehicle.id;
      properties["leg"] = i;
      const PlanStage& driven = vehicle.stages[static_cast<std::size_t>(stage)];
      const Path& path = driven.path;
      if (!path.empty()) place = path.end_pose().position();
      Json geometry;
      if (driven.stop_leg == i) {
        const LatLon p = farm.frame.to_wgs84(place);
        geometry = {{"type", "Point"},
                    {"coordinates", {rounded(p.lon_deg, 8), rounded(p.lat_deg, 8)}}};
        ++stage;
      } else {
        geometry = {{"type", "LineString"}, {"coordinates", leg_coordinates(path, i, farm)}};
      }
      features.push_back({{"type", "Feature"}, {"properties", properties}, {"geometry", geometry}});
    }
  }
  const Json document = {
      {"type", "FeatureCollection"}, {"headland", stamp_json(stamp)}, {"features", features}};
  return document.dump() + "\n";
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

std::string plan_text(const MissionPlan& plan, double planning_s) {
  std::set<std::string> rows;
  int visits = 0;
  int vehicles = 0;
  double min_soc = 1.0;
  for (const VehiclePlan& vehicle : plan.vehicles) {
    vehicles += vehicle.legs.empty() ? 0 : 1;
    min_soc = std::min(min_soc, vehicle.min_soc);
    for (const PlanLeg& leg : vehicle.legs) {
      if (leg.kind == LegKind::kRow) rows.insert(leg.id);
      visits += leg.visit >= 0 ? 1 : 0;
    }
  }
  std::string text = fmt::format(
      "plan       {} ({}), found in {:.2f} s\n"
      "work       {} rows, {:.0f} m{} by {} of {} vehicles\n"
      "driving    {:.0f} m in turns, {:.0f} m in transit\n"
      "energy     {:.2f} kWh, {} charge stop{}, lowest state of charge {:.1f} %\n"
      "margin     {:.2f} kWh above the reserve on reaching a charger from anywhere\n"
      "duration   {}\n",
      config::enum_name(plan.status()), gap_text(plan), planning_s, rows.size(), plan.work_m,
      visits > 0 ? fmt::format(", {} visits", visits) : "", vehicles, plan.vehicles.size(),
      plan.turn_m, plan.transit_m, total_energy(plan) / 3.6e6, plan.charge_stops,
      plan.charge_stops == 1 ? "" : "s", 100.0 * min_soc, plan.min_margin_j / 3.6e6,
      duration_text(plan.makespan_s));
  for (const DroppedWork& work : plan.dropped) {
    text += fmt::format("left out   {}: {}\n", work.id, work.reason);
  }
  return text;
}

}  // namespace headland::apps
