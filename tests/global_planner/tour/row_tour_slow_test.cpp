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

TEST(RowTourQuality, NinetyTwoRowsInTenBlocksComeWithinOnePercent) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    auto problem = testing::synthetic_problem({.blocks = 10, .rows_per_block = 10}, seed);
    // The first 92 rows: nine full blocks and two rows of the tenth.
    problem.transition.conservativeResize(184, 184);
    problem.start.conservativeResize(184);
    problem.finish.conservativeResize(184);
    EXPECT_LT(measure(fmt::format("10 blocks, seed {}", seed), problem).gap_ratio, 0.01);
  }
}

TEST(RowTourQuality, ThousandRowsInFortyBlocksComeWithinTwoPercent) {
  for (const std::uint64_t seed : {1, 2}) {
    const auto problem =
        testing::synthetic_problem({.blocks = 40, .rows_per_block = 25, .extent = 2000.0}, seed);
    EXPECT_LT(measure(fmt::format("40 blocks, seed {}", seed), problem).gap_ratio, 0.02);
  }
}

TEST(RowTourQuality, ThousandScatteredRowsComeWithinThreePercent) {
  const auto problem =
      testing::synthetic_problem({.blocks = 1000, .rows_per_block = 1, .extent = 3000.0}, 1);
  EXPECT_LT(measure("scattered", problem).gap_ratio, 0.03);
}

TEST(RowTourQuality, RowsOnASlopeComeWithinThreePercent) {
  for (const double climb : {1.0, 4.0}) {
    const auto problem = testing::synthetic_problem(
        {.blocks = 40, .rows_per_block = 25, .extent = 2000.0, .climb = climb}, 1);
    EXPECT_LT(measure(fmt::format("40 blocks, climb {}", climb), problem).gap_ratio, 0.03);
  }
}

}  // namespace
}  // namespace headland
