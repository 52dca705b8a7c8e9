// SPDX-License-Identifier: Apache-2.0
// Quality and speed on farms that are too large to solve exactly; prints what it measures.
#include <chrono>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "global_planner/tour/row_tour.hpp"
#include "tests/global_planner/tour/synthetic_farm.hpp"

namespace headland {
namespace {

struct Measured {
  double gap_ratio = 0.0;
  double seconds = 0.0;
};

Measured measure(const std::string& name, const RowTourProblem& problem) {
  const auto begin = std::chrono::steady_clock::now();
  const auto tour = solve_row_tour(problem);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  if (!tour) throw std::runtime_error(to_string(tour.error()));
  const double gap = tour->cost / tour->lower_bound - 1.0;
  fmt::print("{:<34} {:5} rows  cost {:10.2f}  bound {:10.2f}  gap {:6.3f} %  {:6.2f} s\n", name,
             problem.rows(), tour->cost, tour->lower_bound, 100.0 * gap, time.count());
  return {gap, time.count()};
}

TEST(RowTourQuality, NinetyRowsInTenOddBlocksComeWithinOnePercent) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const auto problem = testing::synthetic_problem({.blocks = 10, .rows_per_block = 9}, seed);
    EXPECT_LT(measure(fmt::format("10 blocks of 9, seed {}", seed), problem).gap_ratio, 0.01);
  }
}

// A block with an even number of rows is left by the headland by which it was entered; which of
// the two it is, no inequality of the bound decides, so that it lies lower.
TEST(RowTourQuality, NinetyTwoRowsInTenEvenBlocksComeWithinTenPercent) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    auto problem = testing::synthetic_problem({.blocks = 10, .rows_per_block = 10}, seed);
    // The first 92 rows: nine full blocks and two rows of the tenth.
    problem.transition.conservativeResize(184, 184);
    problem.start.conservativeResize(184);
    problem.finish.conservativeResize(184);
    EXPECT_LT(measure(fmt::format("10 blocks of 10, seed {}", seed), problem).gap_ratio, 0.10);
  }
}

// Whatever the bound says: on problems that can still be solved exactly, the search finds the
// optimum.
TEST(RowTourQuality, SearchFindsTheOptimumOfSmallFarms) {
  int optimal = 0;
  constexpr int kFarms = 24;
  for (int farm = 0; farm < kFarms; ++farm) {
    const auto problem = testing::synthetic_problem(
        {.blocks = 2 + farm % 3, .rows_per_block = 5, .climb = farm % 2 == 0 ? 0.0 : 3.0},
        static_cast<std::uint64_t>(farm));
    const auto exact = solve_row_tour(problem);
    const auto searched = solve_row_tour(problem, {.exact_up_to_rows = 0});
    ASSERT_TRUE(exact && searched);
    EXPECT_LE(searched->lower_bound, exact->cost);
    optimal += searched->cost <= exact->cost * (1.0 + 1e-9) ? 1 : 0;
  }
  EXPECT_GE(optimal, kFarms - 1);
}

TEST(RowTourQuality, SixteenRowsAreSolvedExactlyInAFractionOfASecond) {
  const auto problem = testing::synthetic_problem({.blocks = 4, .rows_per_block = 4}, 1);
  EXPECT_EQ(measure("exact", problem).gap_ratio, 0.0);
}

// Long drives between many blocks: the bound rises slowly here, so that most of the gap is its own.
TEST(RowTourQuality, ThousandRowsInFortyBlocksComeWithinEightPercent) {
  for (const std::uint64_t seed : {1, 2}) {
    const auto problem =
        testing::synthetic_problem({.blocks = 40, .rows_per_block = 25, .extent = 2000.0}, seed);
    EXPECT_LT(measure(fmt::format("40 blocks, seed {}", seed), problem).gap_ratio, 0.08);
  }
}

TEST(RowTourQuality, ThousandScatteredRowsComeWithinTwoPercent) {
  const auto problem =
      testing::synthetic_problem({.blocks = 1000, .rows_per_block = 1, .extent = 3000.0}, 1);
  EXPECT_LT(measure("scattered", problem).gap_ratio, 0.02);
}

TEST(RowTourQuality, ThousandRowsInOneBlockComeWithinOnePercent) {
  const auto problem = testing::synthetic_problem({.blocks = 1, .rows_per_block = 1000}, 1);
  EXPECT_LT(measure("one block", problem).gap_ratio, 0.01);
}

// The bound counts every way with its cheaper direction, which a slope makes looser.
TEST(RowTourQuality, RowsOnASlopeComeWithinTwentyPercent) {
  for (const double climb : {1.0, 4.0}) {
    const auto problem =
        testing::synthetic_problem({.blocks = 10, .rows_per_block = 10, .climb = climb}, 1);
    EXPECT_LT(measure(fmt::format("10 blocks, climb {}", climb), problem).gap_ratio, 0.20);
  }
}

}  // namespace
}  // namespace headland
