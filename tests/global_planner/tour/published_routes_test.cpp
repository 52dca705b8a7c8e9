// SPDX-License-Identifier: Apache-2.0
// The published best routes of Schneider's instances with 100 customers (Erdelic 2022, partial
// recharge), driven again: the reader's problem and the checker must agree with the literature.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "global_planner/tour/instance_io.hpp"
#include "global_planner/tour/tour_solver.hpp"

namespace headland {
namespace {

namespace fs = std::filesystem;

using Names = std::vector<std::string>;

fs::path data_folder() {
  const char* given = std::getenv("HEADLAND_DATA");
  return given != nullptr ? given : fs::path("..") / "shared" / "data";
}

Names split(const std::string& text, char separator) {
  Names parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

// A published route as its stops, with the least charging that keeps its windows. With one rate g
// for all stations the pairs (time, energy) that can be reached anywhere lie on one segment of
// slope g: `time` at `energy`, and up to `room` more of both. What a wait or an empty battery moves
// along it is charged at the station visited last.
class Schedule {
 public:
  Schedule(const RouteInstance& instance, const Names& names)
      : problem_(instance.problem), vehicle_(problem_.vehicles.front()) {
    for (const std::string& name : names) {
      TourStop stop;
      stop.task = index(instance.task_names, name);
      stop.station = index(instance.station_names, name);
      stops_.push_back(stop);
    }
    const auto& full = vehicle_.charging.front().points.back();
    rate_ = full.time_s / full.energy_j;
  }

  TourRoute drive(int number) const {
    const std::vector<double> amounts = charges();
    TourRoute route{number, stops_};
    double time = vehicle_.earliest_s;
    double energy = route.lowest_j = vehicle_.battery_j;
    route.cost = vehicle_.fixed_cost;
    for (std::size_t i = 0; i <= stops_.size(); ++i) {
      const TourLeg& way = way_to(i);
      route.cost += way.cost;
      time += way.duration_s;
      energy -= way.energy_j;
      route.lowest_j = std::min(route.lowest_j, energy);
      if (i == stops_.size()) break;
      TourStop& stop = route.stops[i];
      stop.arrival_s = time;
      stop.arrival_j = energy;
      stop.begin_s = stop.task >= 0 ? std::max(time, task(i).earliest_s) : time;
      time = stop.end_s = stop.begin_s + (stop.task >= 0 ? service(i) : rate_ * amounts[i]);
      energy = stop.end_j = energy + amounts[i];
    }
    route.finish_s = time;
    route.finish_j = energy;
    return route;
  }

 private:
  static int index(const Names& names, const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
  }
  const TourTask& task(std::size_t i) const {
    return problem_.tasks[static_cast<std::size_t>(stops_[i].task)];
  }
  double service(std::size_t i) const {
    return problem_.profiles[0].work[static_cast<std::size_t>(stops_[i].task)][0].duration_s;
  }
  int site(std::size_t i) const {
    const int station = stops_[i].station;
    return station < 0 ? task(i).modes[0].entry
                       : problem_.stations[static_cast<std::size_t>(station)].site;
  }
  const TourLeg& way_to(std::size_t i) const {
    return problem_.way(0, i == 0 ? vehicle_.start : site(i - 1),
                        i == stops_.size() ? vehicle_.finish : site(i));
  }

  std::vector<double> charges() const {
    std::vector<double> amounts(stops_.size(), 0.0);
    double time = vehicle_.earliest_s;
    double energy = vehicle_.battery_j;
    double room = 0.0;
    std::size_t last = 0;
    const auto move = [&](double amount) {
      amount = std::clamp(amount, 0.0, room);
      amounts[last] += amount;
      time += rate_ * amount;
      energy += amount;
      room -= amount;
    };
    for (std::size_t i = 0; i <= stops_.size(); ++i) {
      time += way_to(i).duration_s;
      energy -= way_to(i).energy_j;
      move(-energy);
      if (i == stops_.size()) break;
      if (stops_[i].task >= 0) {
        move((task(i).earliest_s - time) / rate_);
        time = std::max(time, task(i).earliest_s);
        room = std::min(room, (task(i).latest_s - time) / rate_);
        time += service(i);
      } else {
        last = i;
        room = vehicle_.battery_j - energy;
      }
    }
    return amounts;
  }

  const TourProblem& problem_;
  const TourVehicle& vehicle_;
  std::vector<TourStop> stops_;
  double rate_ = 0.0;
};

TourSolution published(const RouteInstance& instance, const std::string& configuration) {
  TourSolution solution;
  Names route;
  for (const std::string& name : split(configuration + ";D0", ';')) {
    if (name != "D0") {
      route.push_back(name);
    } else if (!route.empty()) {
      solution.routes.push_back(
          Schedule(instance, route).drive(static_cast<int>(solution.routes.size())));
      solution.cost += solution.routes.back().cost;
      route.clear();
    }
  }
  return solution;
}

std::map<std::string, Names> best_known(const fs::path& csv) {
  std::map<std::string, Names> rows;
  std::ifstream stream(csv);
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const Names columns = split(line, '\t');
    if (columns.size() == 7) rows[columns[0]] = columns;
  }
  return rows;
}

TEST(PublishedRoutes, AreRightAndAsLongAsPublished) {
  const fs::path folder = data_folder() / "evrptw";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << "; set HEADLAND_DATA";
  const auto rows = best_known(folder / "bks-evrptwpr.csv");
  for (const std::string name : {"c101", "c201", "r101", "r201", "rc101", "rc201"}) {
    std::string key = name;
    for (char& c : key) c = static_cast<char>(std::toupper(c));
    const Names& row = rows.at(key);
    const RouteInstance instance = load_instance(folder / "100" / (name + "_21.txt")).value();
    const TourSolution solution = published(instance, row[6]);
    EXPECT_EQ(check_solution(instance.problem, solution).value_or(""), "") << name;
    const double fixed = instance.problem.vehicles[0].fixed_cost * std::stod(row[1]);
    EXPECT_NEAR(solution.cost - fixed, std::stod(row[2]), 1e-4) << name;

    TourSolution wrong = solution;  // and the checker is not merely lenient
    wrong.routes.front().stops.erase(wrong.routes.front().stops.begin());
    EXPECT_TRUE(check_solution(instance.problem, wrong)) << name;
  }
}

}  // namespace
}  // namespace headland
