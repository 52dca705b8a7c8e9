// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/row_tour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "global_planner/tour/internal/cycle.hpp"
#include "global_planner/tour/internal/one_tree.hpp"
#include "tests/global_planner/tour/synthetic_farm.hpp"

namespace headland {
namespace {

using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Least cost over all orders and directions.
double brute_force(const RowTourProblem& problem) {
  std::vector<int> order(static_cast<std::size_t>(problem.rows()));
  std::iota(order.begin(), order.end(), 0);
  double best = kInfinity;
  do {
    for (int sides = 0; sides < 1 << problem.rows(); ++sides) {
      std::vector<RowVisit> visits;
      for (const int row : order) visits.push_back({row, (sides >> row) & 1});
      best = std::min(best, tour_cost(problem, visits));
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

void expect_each_row_once(const RowTourProblem& problem, const RowTour& tour) {
  std::vector<int> rows;
  for (const RowVisit& v : tour.visits) rows.push_back(v.row);
  std::sort(rows.begin(), rows.end());
  std::vector<int> all(static_cast<std::size_t>(problem.rows()));
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(rows, all);
  EXPECT_DOUBLE_EQ(tour.cost, tour_cost(problem, tour.visits));
  EXPECT_LE(tour.lower_bound, tour.cost);
}

TEST(RowTour, ExactAgreesWithAllOrdersAndDirections) {
  RandomStream random(1, "tour oracle");
  for (int trial = 0; trial < 60; ++trial) {
    const auto problem =
        testing::random_problem(1 + trial % 5, trial % 2 == 0, 0.1 * (trial % 6), random);
    const double best = brute_force(problem);
    const auto tour = solve_row_tour(problem);
    ASSERT_EQ(tour.has_value(), best < kInfinity) << "trial " << trial;
    if (!tour) continue;
    EXPECT_NEAR(tour->cost, best, 1e-9) << "trial " << trial;
    EXPECT_TRUE(tour->optimal);
    EXPECT_EQ(tour->lower_bound, tour->cost);
    expect_each_row_once(problem, *tour);
  }
}

TEST(RowTour, SearchFindsTheOptimumOfSmallProblems) {
  RandomStream random(2, "tour search");
  int solved = 0;
  int compared = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const auto problem =
        testing::random_problem(4 + trial % 8, trial % 2 == 0, trial % 3 == 0 ? 0.3 : 0.0, random);
    const auto exact = solve_row_tour(problem);
    const auto tour = solve_row_tour(problem, {.exact_up_to_rows = 0});
    if (!exact || !tour) continue;
    ++compared;
    EXPECT_GE(tour->cost, exact->cost - 1e-9);
    solved += tour->cost <= exact->cost * (1.0 + 1e-9) ? 1 : 0;
    expect_each_row_once(problem, *tour);
  }
  EXPECT_GT(compared, 180);
  EXPECT_GE(solved, compared * 97 / 100);
}

TEST(RowTour, BoundNeverExceedsTheOptimum) {
  RandomStream random(3, "tour bound");
  for (int trial = 0; trial < 300; ++trial) {
    const auto problem =
        testing::random_problem(3 + trial % 7, trial % 2 == 0, 0.15 * (trial % 4), random);
    const auto exact = solve_row_tour(problem);
    const tour::Cycle cycle(problem);
    // A wrong idea of the optimum must not make the bound wrong either.
    for (const double idea : {kInfinity, 0.0, exact ? exact->cost : 300.0}) {
      const double bound = tour::one_tree_bound(cycle, idea).bound;
      EXPECT_LE(bound, exact ? exact->cost : kInfinity) << "trial " << trial;
    }
  }
}

TEST(RowTour, BoundOfABlockIsTight) {
  double worst = 0.0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const auto problem = testing::synthetic_problem({.blocks = 1, .rows_per_block = 14}, seed);
    const auto exact = solve_row_tour(problem);
    ASSERT_TRUE(exact);
    const double bound = tour::one_tree_bound(tour::Cycle(problem), exact->cost).bound;
    EXPECT_LE(bound, exact->cost);
    worst = std::max(worst, 1.0 - bound / exact->cost);
  }
  EXPECT_LT(worst, 0.03);
}

TEST(RowTour, SixteenRowsAreSolvedExactly) {
  const auto problem =
      testing::synthetic_problem({.blocks = 4, .rows_per_block = 4, .climb = 2.0}, 4);
  const auto exact = solve_row_tour(problem);
  ASSERT_TRUE(exact);
  EXPECT_TRUE(exact->optimal);
  const auto searched = solve_row_tour(problem, {.exact_up_to_rows = 0});
  ASSERT_TRUE(searched);
  EXPECT_NEAR(searched->cost, exact->cost, 1e-6);
}

TEST(RowTour, SameSeedGivesTheSameOrder) {
  const auto problem = testing::synthetic_problem({.blocks = 6, .rows_per_block = 7}, 3);
  const auto one = solve_row_tour(problem, {.seed = 5, .iterations = 500});
  const auto two = solve_row_tour(problem, {.seed = 5, .iterations = 500});
  ASSERT_TRUE(one && two);
  ASSERT_EQ(one->visits.size(), two->visits.size());
  for (std::size_t i = 0; i < one->visits.size(); ++i) {
    EXPECT_EQ(one->visits[i].entry_end(), two->visits[i].entry_end());
  }
  EXPECT_EQ(one->lower_bound, two->lower_bound);
}

TEST(RowTour, MoreKicksNeverCostMore) {
  const auto problem =
      testing::synthetic_problem({.blocks = 8, .rows_per_block = 9, .climb = 3.0}, 2);
  const auto few = solve_row_tour(problem, {.iterations = 1});
  const auto many = solve_row_tour(problem, {.iterations = 5000});
  ASSERT_TRUE(few && many);
  expect_each_row_once(problem, *few);
  expect_each_row_once(problem, *many);
  EXPECT_LE(many->cost, few->cost);
}

TEST(RowTour, ReversedCostsGiveTheReversedTour) {
  // Driving every way backwards from finish to start is the same problem.
  const auto problem =
      testing::synthetic_problem({.blocks = 3, .rows_per_block = 4, .climb = 5.0}, 7);
  RowTourProblem mirrored;
  mirrored.transition = problem.transition.transpose();
  mirrored.start = problem.finish;
  mirrored.finish = problem.start;
  const auto there = solve_row_tour(problem);
  const auto back = solve_row_tour(mirrored);
  ASSERT_TRUE(there && back);
  EXPECT_NEAR(there->cost, back->cost, 1e-9);
}

TEST(RowTour, ErrorNamesTheRowWithoutAWay) {
  for (const int rows : {6, 30}) {
    auto problem = testing::synthetic_problem({.blocks = 1, .rows_per_block = rows}, 1);
    for (const int end : {8, 9}) {
      problem.transition.col(end).setConstant(kInfinity);
      problem.start[end] = kInfinity;
    }
    const auto tour = solve_row_tour(problem);
    ASSERT_FALSE(tour);
    EXPECT_EQ(tour.error().code, ErrorCode::kNoPath);
    EXPECT_THAT(tour.error().what, HasSubstr("row 4: no way leads to it"));
    RowTourProblem mirrored{problem.transition.transpose(), problem.finish, problem.start};
    const auto back = solve_row_tour(mirrored);
    ASSERT_FALSE(back);
    EXPECT_THAT(back.error().what, HasSubstr("row 4: no way leads from it"));
  }
}

TEST(RowTour, RowsMayHangTogetherByOneWayOnly) {
  // A ring road: from row i only to row i + 1; the only tour is 0, 1, 2, ...
  constexpr int kRows = 40;
  RowTourProblem problem;
  problem.transition = Eigen::MatrixXd::Constant(2 * kRows, 2 * kRows, kInfinity);
  problem.start = Eigen::VectorXd::Constant(2 * kRows, kInfinity);
  problem.finish = problem.start;
  for (int r = 0; r + 1 < kRows; ++r) problem.transition(2 * r + 1, 2 * r + 2) = 1.0;
  problem.start[0] = 2.0;
  problem.finish[2 * kRows - 1] = 3.0;
  const auto tour = solve_row_tour(problem);
  ASSERT_TRUE(tour) << to_string(tour.error());
  EXPECT_DOUBLE_EQ(tour->cost, kRows - 1 + 5.0);
  EXPECT_TRUE(tour->optimal);
}

TEST(RowTour, RejectsCostsThatAreNotNumbers) {
  auto problem = testing::synthetic_problem({.blocks = 1, .rows_per_block = 3}, 1);
  problem.transition(0, 3) = std::nan("");
  EXPECT_THROW(static_cast<void>(solve_row_tour(problem)), std::invalid_argument);
  problem.transition.resize(4, 4);
  EXPECT_THROW(static_cast<void>(solve_row_tour(problem)), std::invalid_argument);
  EXPECT_FALSE(solve_row_tour(RowTourProblem{}));
}

}  // namespace
}  // namespace headland
