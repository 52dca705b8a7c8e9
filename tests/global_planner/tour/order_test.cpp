// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/order.hpp"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "global_planner/tour/internal/one_way_tour.hpp"

namespace headland {
namespace {

using namespace tour;

CostMatrix random_costs(int n, RandomStream& random, double missing) {
  CostMatrix costs(n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const bool none = i == j || random.uniform() < missing;
      costs.at(i, j) = none ? kNever : random.index(30);
    }
  }
  return costs;
}

double cheapest_permutation(const CostMatrix& costs, bool one_cycle) {
  Successors order(static_cast<std::size_t>(costs.size));
  std::iota(order.begin(), order.end(), 0);
  double best = kNever;
  do {
    double sum = 0.0;
    for (int i = 0; i < costs.size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const int from = one_cycle ? order[k] : i;
      sum += costs.at(from, order[one_cycle ? (k + 1) % order.size() : k]);
    }
    best = std::min(best, sum);
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TEST(Assignment, IsTheCheapestPermutationAndItsPricesProveIt) {
  RandomStream random(3, "assignment");
  for (int round = 0; round < 300; ++round) {
    const CostMatrix costs = random_costs(1 + random.index(6), random, 0.2);
    const double best = cheapest_permutation(costs, false);
    Assignment assignment;
    ASSERT_EQ(assign(costs, assignment), best < kNever);
    if (!(best < kNever)) continue;
    EXPECT_NEAR(tour_length(costs, assignment.column_of), best, 1e-9);
    EXPECT_NEAR(assignment.bound(), best, 1e-9);
    for (int i = 0; i < costs.size; ++i) {
      for (int j = 0; j < costs.size; ++j) {
        EXPECT_GE(costs.at(i, j) + 1e-9, assignment.row_price[static_cast<std::size_t>(i)] +
                                             assignment.column_price[static_cast<std::size_t>(j)]);
      }
    }
  }
}

TEST(CyclePrices, NeverExceedTheShortestTour) {
  RandomStream random(4, "prices");
  for (int round = 0; round < 100; ++round) {
    const CostMatrix costs = random_costs(3 + random.index(5), random, 0.1);
    const double best = cheapest_permutation(costs, true);
    if (!(best < kNever)) continue;
    const PricedCosts priced = price_cycles(costs, {5.0, 60, {}, {}});
    Assignment plain;
    ASSERT_TRUE(assign(costs, plain));
    EXPECT_LE(priced.bound, best + 1e-6);
    EXPECT_GE(priced.bound, plain.bound() - 1e-9);
  }
}

TEST(AssignmentTree, FindsTheShortestTourOrProvesThereIsNone) {
  RandomStream random(5, "tree");
  int without = 0;
  for (int round = 0; round < 300; ++round) {
    const CostMatrix costs = random_costs(2 + random.index(6), random, round % 3 == 0 ? 0.5 : 0.05);
    const double best = cheapest_permutation(costs, true);
    TreeSearch limits;
    limits.most_nodes = 100000;
    limits.whole_costs = round % 2 == 0;
    const TreeAnswer answer = search_assignments(costs, {costs}, {}, limits);
    without += best < kNever ? 0 : 1;
    EXPECT_EQ(answer.next.empty(), !(best < kNever));
    EXPECT_EQ(answer.cost, best);
    EXPECT_EQ(answer.lower_bound, best);
    const TreeAnswer priced = search_assignments(
        costs, best < kNever ? price_cycles(costs, {5.0, 30, {}, {}}) : PricedCosts{costs}, {},
        limits);
    EXPECT_EQ(priced.cost, best);
  }
  EXPECT_GT(without, 10);
}

TEST(AssignmentTree, ABudgetLeavesAValidBound) {
  RandomStream random(6, "budget");
  for (int round = 0; round < 50; ++round) {
    const CostMatrix costs = random_costs(8, random, 0.0);
    TreeSearch limits;
    limits.most_nodes = 1 + random.index(4);
    const TreeAnswer answer = search_assignments(costs, {costs}, {}, limits);
    const double best = cheapest_permutation(costs, true);
    EXPECT_LE(answer.lower_bound, best);
    EXPECT_GE(answer.cost, best);
  }
}

// Sites 0 (start) and 1 (finish), then two for each task's ends.
TourProblem random_problem(int tasks, int modes, RandomStream& random) {
  TourProblem problem;
  problem.sites = 2 + 2 * tasks;
  TourProfile& profile = problem.profiles.emplace_back();
  for (int i = 0; i < problem.sites * problem.sites; ++i) {
    profile.ways.push_back({random.uniform(0.0, 10.0), random.uniform(0.0, 5.0)});
  }
  for (int t = 0; t < tasks; ++t) {
    const TourMode there{2 + 2 * t, 3 + 2 * t};
    TourTask task;
    task.modes = {there};
    if (modes == 2) task.modes.push_back({there.exit, there.entry});
    problem.tasks.push_back(task);
    profile.work.emplace_back();
    for (int m = 0; m < modes; ++m) {
      profile.work.back().push_back({random.uniform(0.0, 10.0), random.uniform(0.0, 5.0)});
    }
  }
  TourVehicle vehicle;
  vehicle.finish = 1;
  vehicle.fixed_cost = 3.0;
  vehicle.earliest_s = 7.0;
  problem.vehicles = {vehicle};
  problem.duration_weight = 0.5;
  problem.span_weight = 0.25;
  return problem;
}

// The solution that drives an order, for the checker to price.
TourSolution driven(const TourProblem& problem, const OrderAnswer& order) {
  const TourVehicle& vehicle = problem.vehicles.front();
  TourSolution solution;
  TourRoute route;
  route.cost = vehicle.fixed_cost;
  double time = vehicle.earliest_s;
  int at = vehicle.start;
  const auto spend = [&](const TourLeg& leg) {
    route.cost += leg.cost;
    time += leg.duration_s;
  };
  for (const auto& [task, mode] : order.visits) {
    const auto t = static_cast<std::size_t>(task);
    const auto m = static_cast<std::size_t>(mode);
    spend(problem.way(0, at, problem.tasks[t].modes[m].entry));
    const double arrival = time;
    spend(problem.profiles[0].work[t][m]);
    at = problem.tasks[t].modes[m].exit;
    route.stops.push_back({task, mode, -1, arrival, arrival, time, kNever, kNever});
  }
  spend(problem.way(0, at, vehicle.finish));
  route.finish_s = time;
  route.finish_j = route.lowest_j = kNever;
  solution.routes = {route};
  solution.cost = order.cost;
  solution.lower_bound = order.lower_bound;
  solution.optimal = order.optimal;
  return solution;
}

TEST(Order, ItsCostIsTheObjective) {
  RandomStream random(8, "order");
  for (const int modes : {1, 2}) {
    for (const int tasks : {1, 2, 5, 14, 20}) {
      const TourProblem problem = random_problem(tasks, modes, random);
      const auto order = solve_order(problem, {});
      ASSERT_TRUE(order);
      EXPECT_EQ(check_solution(problem, driven(problem, *order)).value_or(""), "")
          << modes << " modes, " << tasks << " tasks";
      EXPECT_TRUE(order->optimal || tasks > 16);
    }
  }
}

TEST(Order, TreeAndDynamicProgrammingAgree) {
  RandomStream random(9, "order");
  for (int round = 0; round < 10; ++round) {
    const TourProblem problem = random_problem(13, 1, random);  // by the tree
    const auto order = solve_order(problem, {});
    ASSERT_TRUE(order);
    EXPECT_TRUE(order->optimal);
    TourProblem two_way = problem;  // by dynamic programming: the second modes are impossible
    for (std::size_t t = 0; t < two_way.tasks.size(); ++t) {
      two_way.tasks[t].modes.push_back(two_way.tasks[t].modes[0]);
      two_way.profiles[0].work[t].push_back({kNever});
    }
    EXPECT_NEAR(solve_order(two_way, {})->cost, order->cost, 1e-9);
  }
}

TEST(Order, NoWayMeansNoOrder) {
  RandomStream random(10, "order");
  TourProblem problem = random_problem(18, 1, random);
  for (int to = 0; to < problem.sites; ++to) {
    problem.profiles[0].ways[static_cast<std::size_t>(3 * problem.sites + to)].cost = kNever;
  }
  EXPECT_FALSE(solve_order(problem, {}));
  problem.vehicles.resize(2);
  EXPECT_FALSE(solve_order(problem, {}));
}

}  // namespace
}  // namespace headland
