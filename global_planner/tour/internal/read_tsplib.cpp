// SPDX-License-Identifier: Apache-2.0
// TSPLIB's TSP and ATSP, its orienteering sister OP (OPLib), and the electric VRP of the IEEE
// WCCI-2020 competition (CEC-12), which looks alike.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "global_planner/tour/internal/tsplib_text.hpp"

namespace headland::tour {
namespace {

void read_round_trip(TsplibText& tsplib, InstanceText& text, RouteInstance& instance) {
  const int count = tsplib.whole("DIMENSION", 2, kMaxNodes);
  const auto length = tsplib.lengths(count);
  if (!text.ok()) return;
  instance.problem.sites = count;
  set_ways(instance.problem, length, 1.0, 0.0, 0.0);
  const auto& ways = instance.problem.profiles.front().ways;
  instance.whole_costs = std::all_of(ways.begin(), ways.end(), [](const TourLeg& way) {
    return way.cost == std::floor(way.cost);
  });
  for (int node = 1; node < count; ++node) add_place(instance, node, std::to_string(node + 1), 0.0);
  instance.start_name = instance.finish_name = '1';
  instance.problem.vehicles.emplace_back();
}

void read_score_tour(TsplibText& tsplib, InstanceText& text, RouteInstance& instance) {
  const int count = tsplib.whole("DIMENSION", 2, kMaxNodes);
  const double budget = tsplib.number("COST_LIMIT", 0.0);
  const auto length = tsplib.lengths(count);
  const std::vector<double> scores = tsplib.values("NODE_SCORE_SECTION", count);
  if (!text.ok()) return;
  instance.problem.sites = count;
  set_orienteering(instance, length, scores, 0, budget, 1);
}

// The depot must be node 1, as it is in all files of the family: -1 ends the list.
void check_depot(TsplibText& tsplib, InstanceText& text) {
  const auto& words = tsplib.section("DEPOT_SECTION", -1);
  if (text.ok() &&
      (words.empty() || words.front().text != "1" || (words.size() > 1 && words[1].text != "-1"))) {
    text.wrong(ErrorCode::kUnsupported, tsplib.line_of("DEPOT_SECTION"),
               "DEPOT_SECTION: the depot is not node 1", "allowed: 1, then -1");
  }
}

// Two routes whose loads fit one vehicle can be driven by it, calling at the depot (a station)
// between them. So some cheapest solution has only pairs that do not fit, fewer than 2 load / Q.
int useful_vehicles(double load, double capacity, int tasks) {
  return std::clamp(static_cast<int>(std::ceil(2.0 * load / capacity)) - 1, 1, std::max(1, tasks));
}

struct ElectricData {
  int customers = 0;  // with the depot
  int stations = 0;
  double capacity = 0.0;
  double battery = 0.0;
  double consumption = 0.0;  // energy per distance
  std::vector<Point> at;
  std::vector<double> demand;
  std::vector<int> station_sites;
};

ElectricData read_electric_data(TsplibText& tsplib, InstanceText& text) {
  ElectricData data;
  data.customers = tsplib.whole("DIMENSION", 1, kMaxNodes);
  data.stations = tsplib.whole("STATIONS", 0, kMaxNodes - data.customers);
  data.capacity = tsplib.number("CAPACITY", 0.0);
  data.battery = tsplib.number("ENERGY_CAPACITY", 0.0);
  data.consumption = tsplib.number("ENERGY_CONSUMPTION", 0.0);
  const bool odd =
      tsplib.has("EDGE_WEIGHT_FORMAT") && tsplib.word("EDGE_WEIGHT_FORMAT") != "EUC_2D";
  if (odd) {
    text.wrong(ErrorCode::kUnsupported, tsplib.line_of("EDGE_WEIGHT_FORMAT"),
               "EDGE_WEIGHT_FORMAT: unknown format", "allowed: EUC_2D");
  }
  if (!text.ok()) return data;
  const int sites = data.customers + data.stations;
  data.at = tsplib.coordinates(sites);
  data.demand = tsplib.values("DEMAND_SECTION", data.customers);
  if (data.stations > 0) {
    for (const Word& word : tsplib.section("STATIONS_COORD_SECTION", data.stations)) {
      data.station_sites.push_back(text.whole(word, "station", data.customers + 1, sites) - 1);
    }
  }
  check_depot(tsplib, text);
  if (text.ok() && !(data.capacity > 0.0 && data.battery > 0.0)) {
    text.wrong(ErrorCode::kOutOfRange, tsplib.line_of("CAPACITY"),
               "CAPACITY or ENERGY_CAPACITY is zero", "allowed: above zero");
  }
  return data;
}

void read_electric(TsplibText& tsplib, InstanceText& text, RouteInstance& instance) {
  const ElectricData data = read_electric_data(tsplib, text);
  if (!text.ok()) return;
  TourProblem& problem = instance.problem;
  problem.sites = data.customers + data.stations;
  const auto at = [&](int site) { return data.at[static_cast<std::size_t>(site)]; };
  set_ways(
      problem, [&](int a, int b) { return euclidean(at(a), at(b)); }, 1.0, 0.0, data.consumption);
  for (int site = 1; site < data.customers; ++site) {
    add_place(instance, site, std::to_string(site + 1), 0.0).demand =
        data.demand[static_cast<std::size_t>(site)];
  }
  instance.start_name = instance.finish_name = '1';
  const double load = std::accumulate(data.demand.begin() + 1, data.demand.end(), 0.0);
  const int vehicles = useful_vehicles(load, data.capacity, data.customers - 1);
  problem.stations.push_back({0, vehicles});
  instance.station_names.emplace_back("1");
  for (const int site : data.station_sites) {
    problem.stations.push_back({site, vehicles});
    instance.station_names.push_back(std::to_string(site + 1));
  }
  TourVehicle vehicle;
  vehicle.load_capacity = data.capacity;
  vehicle.battery_j = vehicle.start_energy_j = data.battery;
  vehicle.charging.assign(problem.stations.size(), {{{0.0, 0.0}, {0.0, data.battery}}});
  problem.vehicles.assign(static_cast<std::size_t>(vehicles), vehicle);
}

}  // namespace

RouteInstance read_tsplib(InstanceText& text) {
  RouteInstance instance;
  TsplibText tsplib(text);
  const std::string type = tsplib.word("TYPE");
  instance.format = type;
  if (type == "TSP" || type == "ATSP") {
    read_round_trip(tsplib, text, instance);
  } else if (type == "OP") {
    read_score_tour(tsplib, text, instance);
  } else if (type == "EVRP") {
    read_electric(tsplib, text, instance);
  } else {
    text.wrong(ErrorCode::kUnsupported, tsplib.line_of("TYPE"), "TYPE: unknown type of problem",
               "allowed: TSP, ATSP, OP, EVRP");
  }
  return instance;
}

}  // namespace headland::tour
