// SPDX-License-Identifier: Apache-2.0
#include "local_planner/mcts/internal/forecast.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace headland::mcts {
namespace {

// One agent that goes from (-5, 0) to the east at 10 m/s, in steps of 1 s.
Prediction fast_agent() {
  Prediction prediction;
  prediction.begin(1.0, 3);
  prediction.ids = {7};
  prediction.radius_m = {0.5};
  for (int k = 1; k <= 3; ++k) {
    prediction.mean.emplace_back(-5.0 + 10.0 * k, 0.0);
    prediction.covariance.push_back(Eigen::Vector2d(0.04, 0.09).asDiagonal());
  }
  return prediction;
}

Forecast forecast_of(const MctsConfig& config) {
  Agent now;
  now.id = 7;
  now.position = {-5.0, 0.0};
  Forecast forecast;
  forecast.set(fast_agent(), {&now, 1}, {0.0, 0.0}, 1.0, config);
  return forecast;
}

TEST(Forecast, SeesAgentsThatPassBetweenTwoSteps) {
  MctsConfig config;
  config.view_m = 20.0;
  const Forecast forecast = forecast_of(config);
  // At both ends of the step the agent is 5 m away, in between it is on top of the robot.
  EXPECT_TRUE(forecast.step(0, 0.0, 0.3, 0.5, 0.3, 0.5).contact);
  EXPECT_FALSE(forecast.step(0, 0.0, 4.0, 0.5, 4.0, 0.5).contact);
  EXPECT_FALSE(forecast.step(0, 0.0, 0.3, 0.0, 0.3, 0.0).contact) << "a standing robot is touched";
  EXPECT_GT(forecast.step(0, 0.0, 0.3, 0.0, 0.3, 0.0).cost, 0.0);
  EXPECT_EQ(forecast.step(0, 0.0, 4.0, 0.5, 4.0, 0.5).cost, 0.0);
}

TEST(Forecast, CountsRiskLessTheFartherAhead) {
  MctsConfig config;
  config.view_m = 40.0;
  const Forecast forecast = forecast_of(config);
  const double now = forecast.step(0, 0.0, 1.6, 0.0, 1.6, 0.0).cost;
  const double later = forecast.step(1, 10.0, 1.6, 10.0, 1.6, 0.0).cost;
  EXPECT_NEAR(later / now, std::exp(-config.step_s / config.trust_s), 1e-5);
}

TEST(Forecast, HasTheUncertaintyOfEquationOneWithinEquationTwosDistance) {
  MctsConfig config;
  config.view_m = 20.0;
  const Forecast forecast = forecast_of(config);
  // U = sqrt(det) = 0.2 * 0.3, alpha = 1 / distance.
  EXPECT_NEAR(forecast.seed_cost(1, 5.0, 2.0), 0.06 / 2.0, 1e-6);
  EXPECT_EQ(forecast.seed_cost(1, 5.0, 3.1), 0.0);
}

TEST(Forecast, LeavesOutWhoIsFarAway) {
  MctsConfig config;
  config.view_m = 4.0;
  EXPECT_EQ(forecast_of(config).agents(), 0);
}

TEST(Forecast, TellsWhereAnAgentWasExpected) {
  MctsConfig config;
  config.view_m = 20.0;
  const Forecast forecast = forecast_of(config);
  Point2 expected;
  ASSERT_TRUE(forecast.expected(7, 1.5, expected));
  EXPECT_NEAR(expected.x(), 10.0, 1e-5);
  EXPECT_FALSE(forecast.expected(8, 1.0, expected));
}

}  // namespace
}  // namespace headland::mcts
