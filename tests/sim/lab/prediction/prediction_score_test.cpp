// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/prediction/prediction_score.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace headland {
namespace {

constexpr WindowShape kShape{0.5, 2, 4, 12, 10.0};

// One agent along x at `speed` whose truth is off by `error` sideways at each step to come, and a
// robot that drives along y, 2 m and more away from it.
CrowdWindow window_of(double speed, double error) {
  CrowdWindow window;
  window.radius_m = {0.5};
  for (int k = 0; k < kShape.moments(); ++k) {
    const double t = 0.5 * (k - 2);
    window.robot.push_back({speed * t - 2.0, 1.0 + 0.8 * t});
    window.position.push_back({speed * t, k > 2 ? error : 0.0});
    window.velocity.push_back({speed, 0.0});
  }
  return window;
}

TEST(PredictionScore, ErrorsAreThoseOfTheMeansAndCountedPerAgent) {
  CoastingPredictor coasting;
  PredictionScorer scorer(kShape);
  scorer.add(window_of(1.0, 0.0), coasting, RobotForetold::kPlan);
  scorer.add(window_of(0.5, 0.6), coasting, RobotForetold::kPlan);
  const PredictionScore score = scorer.score();
  EXPECT_EQ(score.agents_count, 2);
  EXPECT_NEAR(score.ade_m, 0.3, 1e-12);
  EXPECT_NEAR(score.fde_m, 0.3, 1e-12);
}

TEST(PredictionScore, DensityAndSharesAreThoseOfTheGaussian) {
  CoastingPredictor coasting;
  PredictionScorer scorer(kShape);
  const double error = 0.2;
  scorer.add(window_of(1.0, error), coasting, RobotForetold::kPlan);
  double nll = 0.0;
  int within_1 = 0;
  int within_2 = 0;
  for (int k = 1; k <= 4; ++k) {
    const double variance = std::pow(0.5 * 0.3 * std::pow(0.5 * k, 2), 2) + 1e-4;
    nll += 0.25 * (0.5 * error * error / variance + std::log(2.0 * M_PI * variance));
    within_1 += error * error < variance ? 1 : 0;
    within_2 += error * error < 4.0 * variance ? 1 : 0;
  }
  const PredictionScore score = scorer.score();
  EXPECT_NEAR(score.nll, nll, 1e-9);
  EXPECT_EQ(score.within_1_ratio, within_1 / 4.0);
  EXPECT_EQ(score.within_2_ratio, within_2 / 4.0);
}

TEST(PredictionScore, OnlyAgentsThatComeNearAreCounted) {
  CoastingPredictor coasting;
  PredictionScorer near(kShape, 2.25);
  PredictionScorer nearer(kShape, 2.15);
  for (PredictionScorer* scorer : {&near, &nearer}) {
    scorer->add(window_of(1.0, 0.5), coasting, RobotForetold::kPlan);
  }
  EXPECT_EQ(near.score().agents_count, 1);
  EXPECT_EQ(nearer.score().agents_count, 0);
}

// Says that all go where the robot goes, so that what it is told can be seen.
class Follower : public Predictor {
 public:
  void observe(std::span<const Agent> agents, const Point2&, const Point2&, double) override {
    id_ = agents.front().id;
  }
  void predict(std::span<const Point2> path, double step_s, int steps,
               Prediction& prediction) const override {
    prediction = {step_s, steps, {id_}, {0.5}, {path.begin(), path.end()}, {}};
    prediction.covariance.assign(path.size(), Eigen::Matrix2d::Identity());
  }

 private:
  int id_ = 0;
};

TEST(PredictionScore, PredictorsAreToldThePlanOrThatTheRobotGoesOn) {
  CrowdWindow window = window_of(1.0, 0.0);
  window.robot.back() = {50.0, 0.0};
  window.position = window.robot;  // the truth is the robot's own way
  Follower follower;
  PredictionScorer told(kShape);
  PredictionScorer untold(kShape);
  told.add(window, follower, RobotForetold::kPlan);
  untold.add(window, follower, RobotForetold::kCoasting);
  EXPECT_NEAR(told.score().fde_m, 0.0, 1e-12);
  EXPECT_NEAR(untold.score().fde_m, (Point2(50.0, 0.0) - Point2(0.0, 2.6)).norm(), 1e-9);
}

}  // namespace
}  // namespace headland
