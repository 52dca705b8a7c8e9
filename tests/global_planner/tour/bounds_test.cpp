// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/bounds.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "global_planner/tour/tour_solver.hpp"

namespace headland {
namespace {

// Anything goes: no triangle inequality, two profiles, two modes, windows, loads, rewards,
// stations, negative energies, ways that do not exist.
TourProblem random_problem(RandomStream& random) {
  TourProblem problem;
  const int tasks = 1 + random.index(4);
  problem.sites = 2 + 2 * tasks + 1;
  const bool metric = random.index(2) == 0;
  std::vector<double> x;
  for (int s = 0; s < problem.sites; ++s) x.push_back(random.uniform(0.0, 10.0));
  for (int p = 0; p < 1 + random.index(2); ++p) {
    TourProfile& profile = problem.profiles.emplace_back();
    for (int a = 0; a < problem.sites; ++a) {
      for (int b = 0; b < problem.sites; ++b) {
        const double d =
            a == b ? 0.0
            : metric
                ? 1.0 + std::abs(x[static_cast<std::size_t>(a)] - x[static_cast<std::size_t>(b)])
                : random.uniform(0.5, 10.0);
        const double net = d * random.uniform(-0.2, 1.0);
        profile.ways.push_back(
            {d, d * random.uniform(0.8, 1.2), net, std::max(net, 0.0) + 0.1 * d});
      }
    }
  }
  const bool windows = random.index(2) == 0;
  for (int t = 0; t < tasks; ++t) {
    TourTask task;
    task.modes = {{2 + 2 * t, 3 + 2 * t}};
    if (random.index(2) == 0) task.modes.push_back({3 + 2 * t, 2 + 2 * t});
    task.demand = random.index(4);
    if (random.index(2) == 0) task.reward = random.uniform(0.0, 15.0);
    if (windows) {
      task.earliest_s = random.uniform(0.0, 20.0);
      task.latest_s = task.earliest_s + random.uniform(5.0, 30.0);
    }
    for (TourProfile& profile : problem.profiles) {
      profile.work.emplace_back();
      for (std::size_t m = 0; m < task.modes.size(); ++m) {
        const double e = random.uniform(0.0, 2.0);
        profile.work.back().push_back({random.uniform(0.0, 3.0), random.uniform(0.0, 3.0), e, e});
      }
    }
    problem.tasks.push_back(task);
  }
  const bool stations = random.index(2) == 0;
  if (stations) problem.stations = {{problem.sites - 1, 3}};
  TourVehicle vehicle;
  vehicle.finish = random.index(2);
  if (random.index(2) == 0) vehicle.load_capacity = 5.0;
  if (stations || random.index(2) == 0) {
    vehicle.battery_j = vehicle.start_energy_j = random.uniform(10.0, 40.0);
  }
  if (stations) vehicle.charging = {{{{0.0, 0.0}, {2.0, vehicle.battery_j}}}};
  if (random.index(2) == 0) vehicle.latest_s = random.uniform(15.0, 60.0);
  vehicle.earliest_s = random.index(2) * 3.0;
  vehicle.fixed_cost = random.index(2) * random.uniform(0.0, 20.0);
  problem.vehicles.assign(1 + static_cast<std::size_t>(random.index(3)), vehicle);
  if (random.index(2) == 0) problem.vehicles.back().fixed_cost *= 0.5;
  problem.vehicles.back().profile = static_cast<int>(problem.profiles.size()) - 1;
  if (random.index(2) == 0) problem.duration_weight = random.uniform(0.0, 1.0);
  if (random.index(2) == 0) problem.span_weight = random.uniform(0.0, 1.0);
  return problem;
}

TEST(Bounds, NoSolutionCostsLess) {
  RandomStream random(11, "bounds");
  int solved = 0;
  double share = 0.0;
  for (int round = 0; round < 1500; ++round) {
    const TourProblem problem = random_problem(random);
    TourOptions options;
    options.iterations = 200;
    const auto solution = solve_tour(problem, options);
    if (!solution) continue;
    ++solved;
    ASSERT_EQ(check_solution(problem, *solution).value_or(""), "") << round;
    const double bound = tour::lower_bound(problem);
    ASSERT_LE(bound, solution->cost + 1e-6) << round;
    share += solution->cost > 0.0 ? bound / solution->cost : 1.0;
  }
  EXPECT_GT(solved, 500);
  EXPECT_GT(share / solved, 0.8);  // and it is worth something
}

TEST(Bounds, EasyProblemsAreBoundExactly) {
  // Two loads of 6 for vehicles of 10: two vehicles, each there and back.
  TourProblem problem;
  problem.sites = 3;
  problem.profiles.resize(1);
  for (const double d : {0.0, 3.0, 4.0, 3.0, 0.0, 1.0, 4.0, 1.0, 0.0}) {
    problem.profiles[0].ways.push_back({d, d, d, d});
  }
  for (int t = 1; t <= 2; ++t) {
    problem.tasks.push_back({{{t, t}}, 6.0});
    problem.profiles[0].work.push_back({{1.0, 0.0, 0.0, 0.0}});
  }
  TourVehicle vehicle;
  vehicle.load_capacity = 10.0;
  vehicle.fixed_cost = 100.0;
  problem.vehicles.assign(3, vehicle);
  EXPECT_NEAR(tour::lower_bound(problem), 2 * 100 + 6 + 8 + 2, 1e-5);
  problem.tasks[1].reward = 50.0;  // cheaper to leave out
  EXPECT_NEAR(tour::lower_bound(problem), 100 + 6 + 1 + 50, 1e-5);
  problem.tasks[0].reward = 2.0;  // nothing is worth driving for
  EXPECT_NEAR(tour::lower_bound(problem), 52.0, 1e-5);
}

TEST(Bounds, OrienteeringIsBoundByTheTimeThereIs) {
  // Three places 10 away from the start and from each other, 25 to spend: one place. By knapsack
  // alone, with 10 for each place, two and a half.
  TourProblem problem;
  problem.sites = 4;
  problem.profiles.resize(1);
  for (int k = 0; k < 16; ++k) {
    const double d = k / 4 == k % 4 ? 0.0 : 10.0;
    problem.profiles[0].ways.push_back({0.0, d, 0.0, 0.0});
  }
  for (int t = 1; t <= 3; ++t) {
    problem.tasks.push_back({{{t, t}}, 0.0, 6.0});
    problem.profiles[0].work.push_back({{}});
  }
  TourVehicle vehicle;
  vehicle.latest_s = 25.0;
  problem.vehicles = {vehicle};
  const double bound = tour::lower_bound(problem);  // of the score lost; the best loses 12
  EXPECT_LE(bound, 12.0);
  EXPECT_GE(bound, 18.0 - 6.0 * 2.5 + 0.5);
}

TEST(Bounds, LoadsThatDoNotPairNeedAVehicleEach) {
  TourProblem problem;
  TourVehicle vehicle;
  vehicle.load_capacity = 10.0;
  problem.vehicles.assign(9, vehicle);
  for (const double load : {6.0, 6.0, 6.0, 5.0, 5.0, 4.0}) problem.tasks.push_back({{}, load});
  EXPECT_EQ(tour::least_vehicles(problem), 4);  // 32 of load; the 5s fit beside no 6
  problem.tasks[3].reward = 1.0;
  EXPECT_EQ(tour::least_vehicles(problem), 3 + 1);
  problem.tasks[4].reward = 1.0;
  EXPECT_EQ(tour::least_vehicles(problem), 3);
}

}  // namespace
}  // namespace headland
