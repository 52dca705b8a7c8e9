// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/tour_solver.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/global_planner/tour/tour_oracle.hpp"

namespace headland {
namespace {

using test::make_problem;
using test::SmallProblem;
using test::TourOracle;
using ::testing::HasSubstr;

// Solves by exact search and compares with trying everything. Says whether there is a solution.
bool expect_least_cost(const SmallProblem& spec, std::uint64_t seed) {
  SCOPED_TRACE(fmt::format("seed {}", seed));
  const TourProblem problem = make_problem(spec, seed);
  const double least = TourOracle(problem).least_cost();
  const auto solution = solve_tour(problem);
  if (least == kNever) {
    EXPECT_FALSE(solution.has_value())
        << "where there is none, and is " << check_solution(problem, *solution).value_or("valid");
    return false;
  }
  EXPECT_TRUE(solution.has_value()) << to_string(solution.error());
  if (!solution) return false;
  EXPECT_EQ(check_solution(problem, *solution).value_or("valid"), "valid");
  EXPECT_NEAR(solution->cost, least, 1e-6);
  EXPECT_TRUE(solution->optimal);
  return true;
}

void expect_least_costs(const SmallProblem& spec, int seeds) {
  int solvable = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    solvable += expect_least_cost(spec, static_cast<std::uint64_t>(seed));
  }
  EXPECT_GE(4 * solvable, seeds) << "most problems have no solution: they test little";
}

TEST(SolveTour, OneBatteryIsChargedOptimally) { expect_least_costs({.tasks = 4}, 20); }

TEST(SolveTour, ChargingTimeIsWeighedAgainstCost) {
  expect_least_costs({.tasks = 3, .duration_weight = 1.0}, 20);
}

TEST(SolveTour, PartialChargesKeepWindows) {
  expect_least_costs({.tasks = 3, .windows = true, .rewards = true}, 30);
}

TEST(SolveTour, RowsAreDrivenInTheBetterDirectionWithEnergyFromDownhillWays) {
  expect_least_costs({.tasks = 3, .two_modes = true, .downhill = true}, 20);
}

TEST(SolveTour, TasksAreSharedAmongUnlikeVehicles) {
  expect_least_costs({.tasks = 3, .vehicles = 2, .windows = true, .rewards = true, .alike = false},
                     40);
}

TEST(SolveTour, TheLastOfAlikeVehiclesComesHomeEarliest) {
  expect_least_costs({.tasks = 4, .vehicles = 3, .battery = false, .span_weight = 1.0}, 20);
}

TEST(SolveTour, CostAndSpanAreWeighedTogether) {
  expect_least_costs({.tasks = 3, .vehicles = 2, .rewards = true, .span_weight = 2.0}, 15);
}

TEST(SolveTour, OrienteeringLeavesOutWhatCostsMoreThanItIsWorth) {
  expect_least_costs({.tasks = 4, .battery = false, .windows = true, .rewards = true}, 40);
}

// Places on a square, ways as the crow flies, one joule a metre.
TourProblem plane(int tasks, int vehicles, int stations, double battery, std::uint64_t seed) {
  RandomStream random(seed, "plane");
  TourProblem problem;
  problem.sites = 1 + tasks + stations;
  std::vector<std::pair<double, double>> at{{50.0, 50.0}};
  for (int i = 1; i < problem.sites; ++i) {
    at.emplace_back(random.uniform(0.0, 100.0), random.uniform(0.0, 100.0));
  }
  TourProfile profile;
  for (const auto& a : at) {
    for (const auto& b : at) {
      const double d = std::hypot(a.first - b.first, a.second - b.second);
      profile.ways.push_back({d, d, d, d});
    }
  }
  for (int t = 0; t < tasks; ++t) {
    TourTask task;
    task.modes = {{1 + t, 1 + t}};
    task.demand = 1.0;
    problem.tasks.push_back(task);
    profile.work.push_back({{0.0, 5.0, 0.0, 0.0}});
  }
  problem.profiles.push_back(profile);
  TourVehicle vehicle;
  vehicle.load_capacity = std::ceil(1.3 * tasks / vehicles);
  vehicle.battery_j = vehicle.start_energy_j = battery;
  vehicle.reserve_j = 0.1 * battery;
  for (int s = 0; s < stations; ++s) {
    problem.stations.push_back({1 + tasks + s, 1});
    vehicle.charging.push_back({{{0.0, 0.0}, {battery, 0.8 * battery}, {2.0 * battery, battery}}});
  }
  problem.vehicles.assign(static_cast<std::size_t>(vehicles), vehicle);
  return problem;
}

double heuristic_cost(const TourProblem& problem) {
  TourOptions options;
  options.exact_up_to_tasks = 0;
  options.iterations = 4000;
  const auto solution = solve_tour(problem, options);
  if (!solution) return kNever;
  EXPECT_EQ(check_solution(problem, *solution).value_or("valid"), "valid");
  return solution->cost;
}

TEST(SolveTour, RuinAndRecreateComesNearTheOptimum) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    TourProblem problem = plane(10, 2, 2, 180.0, seed);
    problem.duration_weight = seed % 2 == 0 ? 0.5 : 0.0;
    const auto exact = solve_tour(problem);
    ASSERT_TRUE(exact.has_value()) << to_string(exact.error());
    EXPECT_EQ(check_solution(problem, *exact).value_or("valid"), "valid");
    const double found = heuristic_cost(problem);
    EXPECT_GE(found, exact->lower_bound - 1e-6);
    EXPECT_LE(found, 1.01 * exact->cost);
  }
}

// Limits of every kind at once; what is found without exact search is valid, and seldom dearer.
TEST(SolveTour, RuinAndRecreateKeepsEveryLimit) {
  int found = 0;
  int best = 0;
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(fmt::format("problem {}", i));
    const SmallProblem spec{.tasks = 5,
                            .vehicles = 1 + i % 3,
                            .windows = i % 2 == 0,
                            .rewards = i % 5 != 0,
                            .two_modes = i % 3 != 0,
                            .downhill = i % 4 == 0,
                            .alike = i % 2 == 1,
                            .duration_weight = i % 4 == 1 ? 1.0 : 0.0,
                            .span_weight = i % 4 == 3 ? 1.0 : 0.0};
    const TourProblem problem = make_problem(spec, static_cast<std::uint64_t>(100 + i));
    const auto exact = solve_tour(problem);
    const double cost = heuristic_cost(problem);
    if (!exact) {
      EXPECT_EQ(cost, kNever);
      continue;
    }
    EXPECT_EQ(check_solution(problem, *exact).value_or("valid"), "valid");
    EXPECT_GE(cost, exact->cost - 1e-6);
    ++found;
    best += cost <= exact->cost + 1e-6;
  }
  EXPECT_GE(found, 20);
  EXPECT_GE(10 * best, 9 * found);
}

TEST(SolveTour, SameSeedGivesTheSameTour) {
  const TourProblem problem = plane(30, 3, 3, 200.0, 4);
  TourOptions options;
  options.iterations = 500;
  const auto a = solve_tour(problem, options);
  const auto b = solve_tour(problem, options);
  ASSERT_TRUE(a.has_value() && b.has_value());
  EXPECT_EQ(a->cost, b->cost);
  ASSERT_EQ(a->routes.size(), b->routes.size());
  for (std::size_t r = 0; r < a->routes.size(); ++r) {
    ASSERT_EQ(a->routes[r].stops.size(), b->routes[r].stops.size());
    for (std::size_t s = 0; s < a->routes[r].stops.size(); ++s) {
      EXPECT_EQ(a->routes[r].stops[s].task, b->routes[r].stops[s].task);
      EXPECT_EQ(a->routes[r].stops[s].end_j, b->routes[r].stops[s].end_j);
    }
  }
}

TEST(SolveTour, VehiclesQueueAtTheOnlySlot) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    TourProblem problem = plane(12, 4, 1, 240.0, seed);
    problem.span_weight = 1.0;
    for (TourVehicle& vehicle : problem.vehicles) vehicle.start_energy_j = 120.0;
    TourOptions options;
    options.iterations = 1000;
    const auto solution = solve_tour(problem, options);
    ASSERT_TRUE(solution.has_value()) << to_string(solution.error());
    EXPECT_EQ(check_solution(problem, *solution).value_or("valid"), "valid");
  }
}

TEST(SolveTour, StopEndsTheSearchWithAnAnswer) {
  const TourProblem problem = plane(40, 3, 3, 200.0, 2);
  TourOptions options;
  options.iterations = 1'000'000'000;
  int asked = 0;
  options.stop = [&] { return ++asked > 3; };
  const auto solution = solve_tour(problem, options);
  ASSERT_TRUE(solution.has_value());
  EXPECT_EQ(check_solution(problem, *solution).value_or("valid"), "valid");
}

TEST(SolveTour, NoTasksNeedNoRoutes) {
  const auto solution = solve_tour(plane(0, 1, 1, 100.0, 1));
  ASSERT_TRUE(solution.has_value());
  EXPECT_TRUE(solution->routes.empty());
  EXPECT_EQ(solution->cost, 0.0);
  EXPECT_TRUE(solution->optimal);
}

// One task 100 m away that takes 3.6 kJ, and no charger but at the start.
TourProblem far_task() {
  TourProblem problem;
  problem.sites = 2;
  TourProfile profile;
  profile.ways = {{0, 0, 0, 0}, {100, 100, 3600, 3600}, {100, 100, 3600, 3600}, {0, 0, 0, 0}};
  profile.work = {{{0, 10, 3600, 3600}}};
  problem.profiles.push_back(profile);
  problem.tasks.resize(1);
  problem.tasks[0].modes = {{1, 1}};
  TourVehicle vehicle;
  vehicle.battery_j = vehicle.start_energy_j = 9000.0;
  vehicle.reserve_j = 1080.0;
  problem.vehicles.push_back(vehicle);
  return problem;
}

TEST(SolveTour, AnImpossibleTaskIsNamedWithTheMissingEnergy) {
  const auto solution = solve_tour(far_task());
  ASSERT_FALSE(solution.has_value());
  EXPECT_EQ(solution.error().code, ErrorCode::kEnergyInfeasible);
  EXPECT_THAT(solution.error().what, HasSubstr("task 0"));
  EXPECT_THAT(solution.error().what, HasSubstr("short of 0.8 Wh"));  // 3 * 3600 + 1080 - 9000 J
}

TEST(SolveTour, AnImpossibleTaskWithARewardIsDroppedWithTheReason) {
  TourProblem problem = far_task();
  problem.tasks[0].reward = 7.0;
  const auto solution = solve_tour(problem);
  ASSERT_TRUE(solution.has_value());
  ASSERT_EQ(solution->dropped.size(), 1U);
  EXPECT_THAT(solution->dropped[0].reason, HasSubstr("short of 0.8 Wh"));
  EXPECT_EQ(solution->cost, 7.0);
  EXPECT_TRUE(solution->optimal);
}

TEST(SolveTour, LoadAndTimeAreNamedToo) {
  TourProblem heavy = far_task();
  heavy.tasks[0].demand = 2.0;
  heavy.vehicles[0].load_capacity = 1.0;
  EXPECT_EQ(solve_tour(heavy).error().code, ErrorCode::kTaskDoesNotFit);
  TourProblem late = far_task();
  late.tasks[0].latest_s = 50.0;
  EXPECT_EQ(solve_tour(late).error().code, ErrorCode::kTaskDoesNotFit);
  TourProblem walled = far_task();
  walled.profiles[0].ways[1].cost = kNever;
  EXPECT_EQ(solve_tour(walled).error().code, ErrorCode::kNoPath);
}

}  // namespace
}  // namespace headland
