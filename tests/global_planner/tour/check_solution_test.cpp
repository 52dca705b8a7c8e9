// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "global_planner/tour/tour_solver.hpp"

namespace headland {
namespace {

// On a line: sites 0 (depot), 1 and 2 (tasks), 3 (station) at 0, 10, 20 and 15 m; 1 m costs 1,
// takes 1 s and 1 J. Task 1's work takes 2 s and 3 J. Two vehicles, a battery of 30 J with 5 J in
// reserve.
TourProblem line_problem() {
  TourProblem problem;
  problem.sites = 4;
  const double at[] = {0.0, 10.0, 20.0, 15.0};
  TourProfile& profile = problem.profiles.emplace_back();
  for (const double from : at) {
    for (const double to : at) {
      const double d = std::abs(from - to);
      profile.ways.push_back({d, d, d, d});
    }
  }
  profile.work = {{{}}, {{0.5, 2.0, 3.0, 3.0}}};
  problem.tasks.resize(2);
  problem.tasks[0].modes = {{1, 1}};
  problem.tasks[0].demand = 1.0;
  problem.tasks[0].latest_s = 30.0;
  problem.tasks[1].modes = {{2, 2}};
  problem.tasks[1].demand = 2.0;
  problem.tasks[1].earliest_s = 25.0;
  problem.tasks[1].reward = 100.0;
  problem.stations = {{3, 1}};
  TourVehicle vehicle;
  vehicle.load_capacity = 3.0;
  vehicle.battery_j = vehicle.start_energy_j = 30.0;
  vehicle.reserve_j = 5.0;
  vehicle.latest_s = 100.0;
  vehicle.fixed_cost = 7.0;
  vehicle.charging = {{{{0.0, 0.0}, {5.0, 20.0}, {15.0, 30.0}}}};  // 4 J/s, then 1 J/s
  problem.vehicles.assign(2, vehicle);
  problem.duration_weight = 0.1;
  problem.span_weight = 0.01;
  return problem;
}

// 0 -> task 0 -> station (15 to 25 J: from 3.75 to 10 s of its curve) -> task 1 -> station, waiting
// (12 to 21 J: from 3 to 6 s) -> 0.
TourSolution line_solution() {
  TourRoute route;
  route.stops = {{0, 0, -1, 10.0, 10.0, 10.0, 20.0, 20.0},
                 {-1, 0, 0, 15.0, 15.0, 21.25, 15.0, 25.0},
                 {1, 0, -1, 26.25, 26.25, 28.25, 20.0, 17.0},
                 {-1, 0, 0, 33.25, 34.0, 37.0, 12.0, 21.0}};
  route.finish_s = 52.0;
  route.finish_j = 6.0;
  route.lowest_j = 6.0;
  route.cost = 40.5 + 7.0;
  TourSolution solution;
  solution.routes = {route};
  solution.cost = route.cost + 5.2 + 0.52;
  solution.lower_bound = 40.0;
  return solution;
}

std::string complaint(const std::function<void(TourProblem&, TourSolution&)>& change) {
  TourProblem problem = line_problem();
  TourSolution solution = line_solution();
  change(problem, solution);
  return check_solution(problem, solution).value_or("");
}

TEST(CheckSolution, ARightSolutionIsRight) {
  EXPECT_EQ(complaint([](auto&, auto&) {}), "");
}

TEST(CheckSolution, LeavingATaskOutCostsItsReward) {
  const auto solution = [] {
    TourSolution left_out;
    left_out.routes.push_back({0, {{0, 0, -1, 10, 10, 10, 20, 20}}, 27.0, 20.0, 10.0, 10.0});
    left_out.dropped = {{1, "too far"}};
    left_out.cost = 27.0 + 2.0 + 0.2 + 100.0;
    return left_out;
  };
  EXPECT_EQ(check_solution(line_problem(), solution()).value_or(""), "");
  TourProblem must = line_problem();
  must.tasks[1].reward = kNever;
  EXPECT_EQ(check_solution(must, solution()), "task 1 must be done, and is left out");
  TourSolution free = solution();
  free.cost = 29.0;
  EXPECT_EQ(check_solution(line_problem(), free), "the solution costs 129.2, not 29");
  free = solution();
  free.dropped.clear();
  EXPECT_EQ(check_solution(line_problem(), free), "task 1 is done 0 times and left out 0 times");
}

struct Fault {
  std::function<void(TourProblem&, TourSolution&)> change;
  const char* says;
};

TEST(CheckSolution, EveryFaultIsFound) {
  const auto stop = [](TourSolution& s, std::size_t i) -> TourStop& {
    return s.routes[0].stops[i];
  };
  const Fault faults[] = {
      {[&](auto&, auto& s) { stop(s, 0).arrival_s = 9.0; }, "arrives at 10 s, not at 9 s"},
      {[&](auto&, auto& s) { stop(s, 0).arrival_j = 21.0; }, "arrives with 20 J, not with 21 J"},
      {[&](auto&, auto& s) { stop(s, 2).begin_s = 26.0; }, "before it arrives"},
      {[&](auto&, auto& s) { stop(s, 2).end_s = 28.0; }, "ends at 28.25 s, not at 28 s"},
      {[&](auto&, auto& s) { stop(s, 2).end_j = 18.0; }, "ends with 17 J, not with 18 J"},
      {[&](auto& p, auto&) { p.tasks[1].earliest_s = 26.5; }, "outside its window of 26.5 to"},
      {[&](auto& p, auto&) { p.tasks[0].latest_s = 9.0; }, "outside its window of 0 to 9 s"},
      {[&](auto& p, auto&) { p.vehicles[0].load_capacity = 2.5; }, "the load of 3 exceeds"},
      {[&](auto& p, auto&) { p.vehicles[0].reserve_j = 6.5; }, "to 6 J, below the reserve"},
      {[&](auto& p, auto&) { p.profiles[0].work[1][0].peak_j = 15.5; }, "the work takes the batt"},
      {[&](auto& p, auto&) { p.profiles[0].work[1][0].cost = kNever; }, "the work does not exist"},
      {[&](auto& p, auto&) { p.profiles[0].ways[1].cost = kNever; }, "from site 0 to site 1 does"},
      {[&](auto& p, auto&) { p.vehicles[0].finish_energy_j = 6.5; }, "less than the 6.5 J it must"},
      {[&](auto& p, auto&) { p.vehicles[0].latest_s = 51.0; }, "at 52 s, later than 51 s"},
      {[&](auto& p, auto&) { p.vehicles[0].battery_j = 24.0; }, "arrives with 14 J, not with 20 J"},
      {[&](auto& p, auto&) { p.vehicles[0].charging.clear(); }, "this vehicle cannot charge there"},
      {[&](auto& p, auto&) { p.vehicles[0].charging[0].points[1].time_s = 8; }, "which takes"},
      {[&](auto&, auto& s) { stop(s, 3).end_j = 22.0; }, "which takes 4 s"},
      {[&](auto&, auto& s) { stop(s, 3).end_j = 11.0; }, "less than the 12 J it came with"},
      {[&](auto&, auto& s) { stop(s, 3).station = 1; }, "there is no station 1"},
      {[&](auto&, auto& s) { stop(s, 0).task = 5; }, "there is no task 5"},
      {[&](auto&, auto& s) { stop(s, 0).mode = 1; }, "task 0 has no mode 1"},
      {[&](auto&, auto& s) { s.routes[0].vehicle = 2; }, "there is no vehicle 2"},
      {[&](auto&, auto& s) { s.routes.push_back(s.routes[0]); }, "each once"},
      {[&](auto&, auto& s) { s.routes[0].cost = 47.0; }, "the route costs 47.5, not 47"},
      {[&](auto&, auto& s) { s.routes[0].finish_s = 53.0; }, "at 52 s, not at 53 s"},
      {[&](auto&, auto& s) { s.routes[0].finish_j = 7.0; }, "6 J are left, not 7 J"},
      {[&](auto&, auto& s) { s.routes[0].lowest_j = 5.0; }, "lowest is 6 J, not 5 J"},
      {[&](auto&, auto& s) { s.cost = std::nan(""); }, "the solution costs 53.22"},
      {[&](auto&, auto& s) { s.lower_bound = 60.0; }, "lower bound of 60 lies above"},
      {[&](auto&, auto& s) { s.optimal = true; }, "called optimal"},
      {[&](auto&, auto& s) {
         s.dropped = {{0, ""}};
       },
       "task 0 is done 1 times and left out 1"},
  };
  for (const Fault& fault : faults) {
    const std::string said = complaint(fault.change);
    EXPECT_NE(said.find(fault.says), std::string::npos) << said << "\nwanted: " << fault.says;
  }
}

// Two vehicles that only charge, from 15 s on.
TourSolution two_chargers(double second_begin) {
  TourSolution solution;
  for (int v = 0; v < 2; ++v) {
    const double begin = v == 0 ? 15.0 : second_begin;
    TourRoute route{v, {{-1, 0, 0, 15.0, begin, begin + 4.0, 15.0, 20.0}}};
    route.finish_s = begin + 19.0;
    route.finish_j = 5.0;
    route.lowest_j = 5.0;
    route.cost = 37.0;
    solution.routes.push_back(route);
    solution.cost += 37.0 + 0.1 * route.finish_s;
  }
  solution.cost += 0.01 * solution.routes[1].finish_s;
  return solution;
}

TEST(CheckSolution, AStationServesAsManyAsItHasSlots) {
  TourProblem problem = line_problem();
  problem.tasks.clear();
  problem.profiles[0].work.clear();
  EXPECT_EQ(check_solution(problem, two_chargers(18.0)),
            "station 0: 2 vehicles charge at 18 s; it has 1 slots");
  EXPECT_EQ(check_solution(problem, two_chargers(19.0)).value_or(""), "");
  problem.stations[0].slots = 2;
  EXPECT_EQ(check_solution(problem, two_chargers(15.0)).value_or(""), "");
}

TEST(CheckSolution, EnergyBeyondAFullBatteryIsLost) {
  TourProblem problem = line_problem();
  problem.tasks.resize(1);
  problem.profiles[0].ways[1] = {10.0, 10.0, -8.0, 0.0};  // downhill to site 1
  problem.duration_weight = problem.span_weight = 0.0;
  TourSolution solution;
  solution.routes = {{0, {{0, 0, -1, 10, 10, 10, 30, 30}}, 27.0, 20.0, 20.0, 20.0}};
  solution.cost = 27.0;
  EXPECT_EQ(check_solution(problem, solution).value_or(""), "");
}

}  // namespace
}  // namespace headland
