// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/horizon_problem.hpp"

#include <gtest/gtest.h>

#include "tests/control/receding_horizon/problems.hpp"

namespace headland {
namespace {

using testing::guess_of;
using testing::random_problem;

struct Place {
  HorizonState x;
  HorizonControl u;
};

Place random_place(RandomStream& random) {
  Place place;
  place.x << random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), random.uniform(-3.0, 3.0),
      random.uniform(-2.5, 2.5), random.uniform(-0.6, 0.6);
  place.u << random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0);
  return place;
}

TEST(HorizonProblem, DynamicsDerivativesAreThoseOfFiniteDifferences) {
  RandomStream random(1, "places");
  constexpr double kStep = 1e-6;
  for (int trial = 0; trial < 300; ++trial) {
    const HorizonProblem problem = random_problem(random);
    const Place at = random_place(random);
    HorizonProblem::StateMatrix by_state;
    HorizonProblem::ControlMatrix by_control;
    const HorizonState after = problem.next(at.x, at.u, by_state, by_control);
    EXPECT_LT((after - problem.next(at.x, at.u)).norm(), 1e-13);
    for (int i = 0; i < 5; ++i) {
      const HorizonState step = kStep * HorizonState::Unit(i);
      const HorizonState slope =
          (problem.next(at.x + step, at.u) - problem.next(at.x - step, at.u)) / (2.0 * kStep);
      EXPECT_LT((slope - by_state.col(i)).norm(), 1e-8);
    }
    for (int i = 0; i < 2; ++i) {
      const HorizonControl step = kStep * HorizonControl::Unit(i);
      const HorizonState slope =
          (problem.next(at.x, at.u + step) - problem.next(at.x, at.u - step)) / (2.0 * kStep);
      EXPECT_LT((slope - by_control.col(i)).norm(), 1e-8);
    }
  }
}

TEST(HorizonProblem, DynamicsCurvatureIsThatOfTheJacobiansDifferences) {
  RandomStream random(2, "places");
  constexpr double kStep = 1e-6;
  for (int trial = 0; trial < 300; ++trial) {
    const HorizonProblem problem = random_problem(random);
    const Place at = random_place(random);
    HorizonState multiplier;
    for (int i = 0; i < 5; ++i) multiplier(i) = random.uniform(-2.0, 2.0);
    const auto gradient = [&](const Eigen::Matrix<double, 7, 1>& z) {
      HorizonProblem::StateMatrix by_state;
      HorizonProblem::ControlMatrix by_control;
      problem.next(z.head<5>(), z.tail<2>(), by_state, by_control);
      Eigen::Matrix<double, 7, 1> g;
      g << by_state.transpose() * multiplier, by_control.transpose() * multiplier;
      return g;
    };
    Eigen::Matrix<double, 7, 1> z;
    z << at.x, at.u;
    const Eigen::Matrix<double, 7, 7> curvature = problem.curvature(at.x, at.u, multiplier);
    for (int i = 0; i < 7; ++i) {
      const Eigen::Matrix<double, 7, 1> step = kStep * Eigen::Matrix<double, 7, 1>::Unit(i);
      EXPECT_LT(
          ((gradient(z + step) - gradient(z - step)) / (2.0 * kStep) - curvature.col(i)).norm(),
          1e-7);
    }
  }
}

TEST(HorizonProblem, CostIsQuadraticWithTheWeightsAsItsHessian) {
  RandomStream random(3, "places");
  const HorizonProblem problem = random_problem(random);
  const HorizonPlan plan = guess_of(problem);
  constexpr double kStep = 1e-3;
  for (int k = 0; k <= problem.intervals(); ++k) {
    for (int i = 0; i < 5; ++i) {
      HorizonPlan more = plan;
      HorizonPlan less = plan;
      more.states[static_cast<std::size_t>(k)](i) += kStep;
      less.states[static_cast<std::size_t>(k)](i) -= kStep;
      const double slope = (cost(problem, more) - cost(problem, less)) / (2.0 * kStep);
      const HorizonState off = plan.states[static_cast<std::size_t>(k)] - problem.stage(k).wanted;
      EXPECT_NEAR(slope, (problem.state_weight(k) * off)(i), 1e-8);
      const double bend =
          (cost(problem, more) + cost(problem, less) - 2.0 * cost(problem, plan)) / (kStep * kStep);
      EXPECT_NEAR(bend, problem.state_weight(k)(i, i), 1e-6);
    }
  }
  HorizonPlan pushed = plan;
  pushed.controls[3] += HorizonControl(0.1, -0.2);
  const HorizonControl before = plan.controls[3] - problem.stage(3).control;
  const HorizonControl after = pushed.controls[3] - problem.stage(3).control;
  const double change =
      0.5 * (problem.weights.acceleration_weight * (after(0) * after(0) - before(0) * before(0)) +
             problem.weights.turn_rate_weight * (after(1) * after(1) - before(1) * before(1)));
  EXPECT_NEAR(cost(problem, pushed) - cost(problem, plan), change, 1e-10);
}

TEST(HorizonPlan, ShiftedByAnIntervalIsTheNextBordersPlan) {
  RandomStream random(4, "places");
  const HorizonProblem problem = random_problem(random);
  const HorizonPlan plan = guess_of(problem);
  HorizonPlan shifted(problem.intervals());
  plan.shift_into(shifted, problem.interval_s, problem.interval_s);
  EXPECT_LT((shifted.states[4] - plan.states[5]).norm(), 1e-12);
  EXPECT_EQ(shifted.states[15], plan.states[15]);
  plan.shift_into(shifted, 0.0, problem.interval_s);
  EXPECT_EQ(shifted.states[7], plan.states[7]);
  plan.shift_into(shifted, 100.0, problem.interval_s);
  EXPECT_EQ(shifted.states[0], plan.states[15]);
}

}  // namespace
}  // namespace headland
