// SPDX-License-Identifier: Apache-2.0
// The published routing instances: sizes that the exact search proves, and those it does not.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "global_planner/tour/instance_io.hpp"
#include "global_planner/tour/tour_solver.hpp"

namespace headland {
namespace {

namespace fs = std::filesystem;

fs::path data(const char* folder) {
  const char* given = std::getenv("HEADLAND_DATA");
  return (given != nullptr ? fs::path(given) : fs::path("..") / "shared" / "data") / folder;
}

TourSolution solved(const fs::path& file, RouteInstance& instance) {
  auto loaded = load_instance(file);
  EXPECT_TRUE(loaded.has_value()) << file;
  if (!loaded) return {};
  instance = std::move(*loaded);
  const auto solution = solve_tour(instance.problem);
  EXPECT_TRUE(solution.has_value()) << file;
  if (!solution) return {};
  EXPECT_EQ(check_solution(instance.problem, *solution).value_or("valid"), "valid") << file;
  return *solution;
}

double distance(const RouteInstance& instance, const TourSolution& solution) {
  double sum = 0.0;
  for (const TourRoute& route : solution.routes) {
    sum +=
        route.cost - instance.problem.vehicles[static_cast<std::size_t>(route.vehicle)].fixed_cost;
  }
  return sum;
}

// Vehicles and distance with partial recharging, as published (Keskin and Catay 2016).
TEST(TourInstances, SmallElectricRoutesAreProven) {
  const fs::path folder = data("evrptw");
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << "; set HEADLAND_DATA";
  struct Best {
    const char* file;
    int vehicles;
    double distance;
  };
  const Best best[] = {{"5/c101C5.txt", 2, 257.75},    {"5/r203C5.txt", 1, 179.06},
                       {"10/c101C10.txt", 3, 388.25},  {"10/rc102C10.txt", 4, 423.51},
                       {"15/c103C15.txt", 3, 348.46},  {"15/r202C15.txt", 1, 507.32},
                       {"15/rc108C15.txt", 3, 370.25}, {"15/r209C15.txt", 1, 313.24}};
  for (const Best& known : best) {
    RouteInstance instance;
    const TourSolution solution = solved(folder / known.file, instance);
    EXPECT_EQ(static_cast<int>(solution.routes.size()), known.vehicles) << known.file;
    EXPECT_NEAR(distance(instance, solution), known.distance, 0.006) << known.file;
    EXPECT_TRUE(solution.optimal) << known.file;
  }
}

TEST(TourInstances, ElectricRoutesReachThePublishedLength) {
  const fs::path folder = data("evrp");
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << "; set HEADLAND_DATA";
  const std::pair<const char*, double> best[] = {
      {"E-n22-k4.evrp", 384.679}, {"E-n30-k3.evrp", 509.471}, {"E-n51-k5.evrp", 529.902}};
  for (const auto& [file, length] : best) {
    RouteInstance instance;
    EXPECT_LE(solved(folder / file, instance).cost, length) << file;
  }
}

TEST(TourInstances, OrienteeringCollectsThePublishedScore) {
  const fs::path folder = data("op");
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << "; set HEADLAND_DATA";
  const std::pair<const char*, double> best[] = {
      {"Tsiligirides_1/tsiligirides_problem_1_budget_40.txt", 155},
      {"Tsiligirides_3/tsiligirides_problem_3_budget_050.txt", 520},
      {"ChaoSet_64/set_64_1_45.txt", 816}};
  for (const auto& [file, score] : best) {
    RouteInstance instance;
    const TourSolution solution = solved(folder / file, instance);
    double collected = 0.0;
    for (const TourTask& task : instance.problem.tasks) collected += task.reward;
    for (const DroppedTask& drop : solution.dropped) {
      collected -= instance.problem.tasks[static_cast<std::size_t>(drop.task)].reward;
    }
    EXPECT_EQ(collected, score) << file;
  }
}

}  // namespace
}  // namespace headland
