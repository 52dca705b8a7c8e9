// SPDX-License-Identifier: Apache-2.0
// E-VRPTW in the format of Schneider, Stenger and Goeke (2014): a table of places (d depot,
// f station, c customer), then the vehicle, each value between slashes. Charging is partial and at
// a constant rate (Keskin and Catay 2016); fewest vehicles first, then the shortest ways.
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "global_planner/tour/internal/instance_text.hpp"

namespace headland::tour {
namespace {

constexpr std::size_t kColumns = 8;  // id type x y demand ready due service

struct Place {
  std::string id;
  char type = 'c';
  Point at;
  double demand = 0.0;
  double ready = 0.0;
  double due = 0.0;
  double service = 0.0;
};

struct Vehicle {
  double tank = 0.0;         // Q, energy
  double load = 0.0;         // C
  double consumption = 0.0;  // r, energy per distance
  double refuelling = 0.0;   // g, time per energy
  double velocity = 0.0;     // v, distance per time
};

Place read_place(InstanceText& text, const std::vector<Word>& words) {
  Place place;
  const std::string_view type = words[1].text;
  if (type != "d" && type != "f" && type != "c") {
    text.wrong(ErrorCode::kUnknownName, words[1].line, "unknown type of place",
               "allowed: d (depot), f (station), c (customer)");
  }
  place.id = words[0].text;
  place.type = type.front();
  place.at = {text.number(words[2], "x", -1e9), text.number(words[3], "y", -1e9)};
  place.demand = text.number(words[4], "demand", 0.0);
  place.ready = text.number(words[5], "ReadyTime", 0.0);
  place.due = text.number(words[6], "DueDate", 0.0);
  place.service = text.number(words[7], "ServiceTime", 0.0);
  if (text.ok() && place.due < place.ready) {
    text.wrong(ErrorCode::kOutOfRange, words[6].line, "DueDate lies before ReadyTime",
               "allowed: ReadyTime or later");
  }
  return place;
}

// A line such as `Q Vehicle fuel tank capacity /77.75/`.
void read_value(InstanceText& text, const std::vector<Word>& words, Vehicle& vehicle,
                std::string& seen) {
  const int line = words.front().line;
  const std::string_view whole = text.line_text(line);
  const std::size_t open = whole.find('/');
  const std::size_t close = whole.find('/', open == std::string_view::npos ? open : open + 1);
  const std::string_view key = words.front().text;
  if (key.size() != 1 || std::string_view("QCrgv").find(key) == std::string_view::npos ||
      close == std::string_view::npos) {
    text.wrong(ErrorCode::kSyntax, line, "neither a place nor a value of the vehicle",
               "allowed: eight columns, or one of Q, C, r, g, v with its value between slashes");
    return;
  }
  const double value = text.number({whole.substr(open + 1, close - open - 1), line}, key, 0.0);
  seen += key;
  (key == "Q"   ? vehicle.tank
   : key == "C" ? vehicle.load
   : key == "r" ? vehicle.consumption
   : key == "g" ? vehicle.refuelling
                : vehicle.velocity) = value;
}

// No tour of all customers is as long: each by itself, by way of the farthest stations.
double more_than_any_tour(const TourProblem& problem) {
  double longest = 1.0;
  for (const TourLeg& way : problem.profiles.front().ways) longest = std::max(longest, way.cost);
  const auto tasks = static_cast<double>(problem.tasks.size());
  const double ways = (tasks + 1.0) * (1.0 + static_cast<double>(problem.stations.size()));
  return std::pow(10.0, std::ceil(std::log10(longest * ways)));
}

void build(RouteInstance& instance, const std::vector<Place>& places, const Vehicle& v) {
  TourProblem& problem = instance.problem;
  problem.sites = static_cast<int>(places.size());
  const auto place = [&](int i) -> const Place& { return places[static_cast<std::size_t>(i)]; };
  set_ways(
      problem, [&](int a, int b) { return euclidean(place(a).at, place(b).at); }, 1.0,
      1.0 / v.velocity, v.consumption);
  TourVehicle vehicle;
  vehicle.load_capacity = v.load;
  vehicle.battery_j = vehicle.start_energy_j = v.tank;
  for (int site = 0; site < problem.sites; ++site) {
    const Place& p = place(site);
    if (p.type == 'd') {
      vehicle.start = vehicle.finish = site;
      vehicle.earliest_s = p.ready;
      vehicle.latest_s = p.due;
      instance.start_name = instance.finish_name = p.id;
    } else if (p.type == 'f') {
      problem.stations.push_back({site, 1});
      instance.station_names.push_back(p.id);
      vehicle.charging.push_back({{{0.0, 0.0}, {v.tank * v.refuelling, v.tank}}});
    } else {
      TourTask& task = add_place(instance, site, p.id, p.service);
      task.demand = p.demand;
      task.earliest_s = p.ready;
      task.latest_s = p.due;
    }
  }
  vehicle.fixed_cost = more_than_any_tour(problem);
  problem.vehicles.assign(std::max<std::size_t>(1, problem.tasks.size()), vehicle);
  for (TourStation& station : problem.stations) {
    station.slots = static_cast<int>(problem.vehicles.size());  // as many as come
  }
}

}  // namespace

RouteInstance read_schneider(InstanceText& text) {
  RouteInstance instance;
  instance.format = "E-VRPTW";
  instance.objective = RouteObjective::kFleetThenDistance;
  instance.numeric_names = false;
  std::vector<Place> places;
  Vehicle vehicle;
  std::string seen;
  int depots = 0;
  for (std::size_t i = 1; i < text.lines().size() && text.ok(); ++i) {
    const auto& words = text.lines()[i];
    if (words.size() == kColumns && words[1].text.size() == 1) {
      places.push_back(read_place(text, words));
      depots += places.back().type == 'd' ? 1 : 0;
    } else {
      read_value(text, words, vehicle, seen);
    }
  }
  for (const char key : {'Q', 'C', 'r', 'g', 'v'}) {
    if (std::count(seen.begin(), seen.end(), key) == 1) continue;
    text.wrong(ErrorCode::kMissingKey, text.last_line(), fmt::format("no value of {}, or two", key),
               "the vehicle is described by Q, C, r, g and v, once each, behind the places");
  }
  if (depots != 1) {
    text.wrong(ErrorCode::kSyntax, text.last_line(), fmt::format("{} depots", depots),
               "allowed: one place of type d");
  }
  if (text.ok() && !(vehicle.velocity > 0.0 && vehicle.tank > 0.0)) {
    text.wrong(ErrorCode::kOutOfRange, text.last_line(), "Q or v is zero", "allowed: above zero");
  }
  if (static_cast<int>(places.size()) > kMaxNodes) {
    text.wrong(ErrorCode::kOutOfRange, text.last_line(), fmt::format("{} places", places.size()),
               fmt::format("allowed: up to {}", kMaxNodes));
  }
  if (text.ok()) build(instance, places, vehicle);
  return instance;
}

}  // namespace headland::tour
