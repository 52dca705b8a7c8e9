// SPDX-License-Identifier: Apache-2.0
// The row order of seed 002 (EBS221): N = 10 rows, W = 2.5 m apart, RL = 20 m long, wheelbase 3 m,
// depot at (-3 W, RL / 2). Its genetic algorithm reports 114.41 m (60 deg) and 297.07 m (30 deg).
#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "global_planner/tour/row_tour.hpp"

namespace headland {
namespace {

constexpr int kRows = 10;
constexpr double kWidth = 2.5;
constexpr double kLength = 20.0;
constexpr double kWheelbase = 3.0;
constexpr double kPi = std::numbers::pi;
const double kRadius60 = kWheelbase / std::tan(60.0 * kPi / 180.0);
const double kRadius30 = kWheelbase / std::tan(30.0 * kPi / 180.0);

// The seed's own turn costs: its Omega is a full circle, its Pi half of one and a straight.
double seed_turn(int jump, double radius) {
  if (radius <= jump * kWidth / 2.0) return kPi * radius + (jump - 1) * kWidth;
  return 2.0 * kPi * radius;
}

// Lengths of the shortest forward turns.
double true_turn(int jump, double radius) {
  const double d = jump * kWidth;
  if (d >= 2.0 * radius) return d + (kPi - 2.0) * radius;
  return radius * (3.0 * kPi - 4.0 * std::asin((2.0 * radius + d) / (4.0 * radius)));
}

RowTourProblem ebs221_problem(double (*turn)(int, double), double radius) {
  RowTourProblem problem;
  problem.transition =
      Eigen::MatrixXd::Constant(2 * kRows, 2 * kRows, std::numeric_limits<double>::infinity());
  problem.start.resize(2 * kRows);
  for (int e = 0; e < 2 * kRows; ++e) {
    const double x = kWidth / 2.0 + kWidth * (e / 2);
    const double y = kLength * (e % 2);
    problem.start[e] = std::abs(x + 3.0 * kWidth) + std::abs(y - kLength / 2.0);
    for (int f = 0; f < 2 * kRows; ++f) {
      const int jump = std::abs(e / 2 - f / 2);
      if (e % 2 == f % 2 && jump > 0) problem.transition(e, f) = turn(jump, radius);
    }
  }
  problem.finish = problem.start;
  return problem;
}

// Rows counted from 1, as in the seed; the first is entered at its lower end.
double cost_of(const RowTourProblem& problem, const std::vector<int>& rows) {
  std::vector<RowVisit> visits;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    visits.push_back({rows[i] - 1, static_cast<int>(i % 2)});
  }
  return tour_cost(problem, visits);
}

double optimum(const RowTourProblem& problem) {
  const auto tour = solve_row_tour(problem);
  EXPECT_TRUE(tour && tour->optimal);
  return tour ? tour->cost : 0.0;
}

TEST(Ebs221, SixtyDegreeOptimumIsWhatTheSeedFound) {
  const auto problem = ebs221_problem(seed_turn, kRadius60);
  EXPECT_NEAR(optimum(problem), 114.41398, 1e-5);
  EXPECT_NEAR(cost_of(problem, {1, 3, 5, 7, 9, 10, 8, 6, 4, 2}), 114.41398, 1e-5);
}

TEST(Ebs221, ThirtyDegreeOptimumBeatsTheSeed) {
  const auto problem = ebs221_problem(seed_turn, kRadius30);
  EXPECT_NEAR(optimum(problem), 294.56614, 1e-5);
  EXPECT_NEAR(cost_of(problem, {1, 6, 7, 5, 10, 4, 9, 3, 8, 2}), 297.0661, 1e-4);
}

TEST(Ebs221, TrueTurnLengthsShortenBothTours) {
  EXPECT_NEAR(optimum(ebs221_problem(true_turn, kRadius60)), 104.959, 1e-3);
  EXPECT_NEAR(optimum(ebs221_problem(true_turn, kRadius30)), 213.635, 1e-3);
}

TEST(Ebs221, LocalSearchFindsTheSameOptima) {
  for (const double radius : {kRadius60, kRadius30}) {
    for (const auto turn : {seed_turn, true_turn}) {
      const auto problem = ebs221_problem(turn, radius);
      const auto searched = solve_row_tour(problem, {.exact_up_to_rows = 0});
      ASSERT_TRUE(searched);
      EXPECT_NEAR(searched->cost, optimum(problem), 1e-6);
    }
  }
}

}  // namespace
}  // namespace headland
