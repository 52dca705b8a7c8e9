// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/assignment.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

double cost_of(const PairCosts& costs, std::span<const int> column_of) {
  double sum = 0.0;
  for (int row = 0; row < costs.rows(); ++row) {
    const int column = column_of[static_cast<std::size_t>(row)];
    if (column >= 0) sum += costs.at(row, column);
  }
  return sum;
}

// The least sum of all pairings of the rows from `row` on with the columns not in `taken`.
double least(const PairCosts& costs, int row, unsigned taken) {
  if (row == costs.rows()) return 0.0;
  double best = least(costs, row + 1, taken);
  for (int column = 0; column < costs.columns(); ++column) {
    if ((taken >> column & 1u) || !std::isfinite(costs.at(row, column))) continue;
    best = std::min(best, costs.at(row, column) + least(costs, row + 1, taken | 1u << column));
  }
  return best;
}

PairCosts random_costs(RandomStream& random, int rows, int columns, double forbidden) {
  PairCosts costs;
  costs.reset(rows, columns);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (random.uniform() >= forbidden) costs.at(row, column) = random.uniform(-1.0, 0.3);
    }
  }
  return costs;
}

TEST(PairAssignment, IsTheBestOfAllPairings) {
  RandomStream random(1, "pair_assignment");
  PairAssignment assignment;
  for (int trial = 0; trial < 3000; ++trial) {
    const PairCosts costs =
        random_costs(random, random.index(7), random.index(7), random.uniform(0.0, 0.8));
    const std::span<const int> column_of = assignment.solve(costs);
    EXPECT_NEAR(cost_of(costs, column_of), least(costs, 0, 0), 1e-12);
    for (std::size_t row = 0; row < column_of.size(); ++row) {
      if (column_of[row] < 0) continue;
      EXPECT_EQ(assignment.row_of()[static_cast<std::size_t>(column_of[row])],
                static_cast<int>(row));
    }
  }
}

TEST(PairAssignment, EachColumnIsTakenOnce) {
  RandomStream random(2, "pair_assignment");
  PairAssignment assignment;
  for (int trial = 0; trial < 20; ++trial) {
    const PairCosts costs = random_costs(random, 40, 30, 0.5);
    std::vector<int> taken(30, 0);
    for (const int column : assignment.solve(costs)) {
      if (column >= 0) ++taken[static_cast<std::size_t>(column)];
    }
    EXPECT_LE(*std::max_element(taken.begin(), taken.end()), 1);
  }
}

TEST(PairAssignment, LargeRewardsGiveAsManyPairsAsThereCanBe) {
  PairAssignment assignment;
  PairCosts costs;
  costs.reset(2, 2);
  costs.at(0, 0) = 1.0 - 1000.0;
  costs.at(0, 1) = 90.0 - 1000.0;
  costs.at(1, 0) = 2.0 - 1000.0;
  const std::span<const int> column_of = assignment.solve(costs);
  EXPECT_EQ(column_of[0], 1);
  EXPECT_EQ(column_of[1], 0);
}

TEST(PairAssignment, ForbiddenAndWorthlessPairsAreNotMade) {
  PairAssignment assignment;
  PairCosts costs;
  costs.reset(2, 3);
  costs.at(0, 0) = std::nan("");
  costs.at(0, 1) = 0.5;
  costs.at(1, 2) = std::numeric_limits<double>::infinity();
  for (const int column : assignment.solve(costs)) EXPECT_EQ(column, -1);
}

TEST(PairAssignment, NothingToPairIsNoPair) {
  PairAssignment assignment;
  PairCosts costs;
  costs.reset(0, 3);
  EXPECT_TRUE(assignment.solve(costs).empty());
  costs.reset(3, 0);
  EXPECT_EQ(assignment.solve(costs).size(), 3u);
}

TEST(PairAssignment, DoesNotAllocateOnceItHasHeldAsMany) {
  RandomStream random(3, "pair_assignment");
  PairAssignment assignment;
  const PairCosts costs = random_costs(random, 30, 30, 0.3);
  assignment.solve(costs);
  const long before = testing::allocation_count();
  assignment.solve(costs);
  EXPECT_EQ(testing::allocation_count(), before);
}

}  // namespace
}  // namespace headland
