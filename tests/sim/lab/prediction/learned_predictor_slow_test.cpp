// SPDX-License-Identifier: Apache-2.0
// The shipped weights on crowds that they were not trained on.
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "local_planner/prediction/learned_predictor.hpp"
#include "sim/lab/prediction/prediction_score.hpp"

namespace headland {
namespace {

constexpr std::uint64_t kSeed = 1000;  // training used 3 to 5
constexpr double kNear = 3.0;

struct Scores {
  PredictionScore coasting;
  PredictionScore untold;
  PredictionScore told;
};

Scores scores_near_the_robot(CrowdScene scene, int episodes) {
  const WindowShape shape;
  const auto network = load_network(HEADLAND_SOURCE_DIR "/config/models/crowd_response.weights");
  EXPECT_TRUE(network);
  PredictionScorer coasting(shape, kNear);
  PredictionScorer untold(shape, kNear);
  PredictionScorer told(shape, kNear);
  CoastingPredictor coast;
  for (const CrowdWindow& window : record_windows(scene, shape, episodes, kSeed)) {
    LearnedPredictor learned(*network, window.robot_radius_m);
    coasting.add(window, coast, RobotForetold::kPlan);
    untold.add(window, learned, RobotForetold::kCoasting);
    told.add(window, learned, RobotForetold::kPlan);
  }
  const Scores scores{coasting.score(), untold.score(), told.score()};
  std::printf("%s: constant velocity %.3f / %.3f m, untold %.3f / %.3f m, told %.3f / %.3f m\n",
              std::string(config::enum_name(scene)).c_str(), scores.coasting.ade_m,
              scores.coasting.fde_m, scores.untold.ade_m, scores.untold.fde_m, scores.told.ade_m,
              scores.told.fde_m);
  EXPECT_GT(scores.told.agents_count, 500);
  return scores;
}

TEST(LearnedPredictorOnCrowds, BeatsConstantVelocityNearTheRobotInDenseCrowds) {
  const Scores s = scores_near_the_robot(CrowdScene::kDense, 20);
  EXPECT_LT(s.told.ade_m, 0.85 * s.coasting.ade_m);
  EXPECT_LT(s.told.fde_m, 0.85 * s.coasting.fde_m);
  EXPECT_LT(s.told.ade_m, 0.95 * s.untold.ade_m) << "the robot's plan helps";
}

TEST(LearnedPredictorOnCrowds, BeatsConstantVelocityNearTheRobotInSparseCrowds) {
  const Scores s = scores_near_the_robot(CrowdScene::kSparse, 20);
  EXPECT_LT(s.told.ade_m, 0.85 * s.coasting.ade_m);
  EXPECT_LT(s.told.fde_m, 0.85 * s.coasting.fde_m);
  EXPECT_LT(s.told.ade_m, 0.90 * s.untold.ade_m);
}

TEST(LearnedPredictorOnCrowds, BeatsConstantVelocityWherePeopleCross) {
  const Scores s = scores_near_the_robot(CrowdScene::kCrossing, 60);
  EXPECT_LT(s.told.ade_m, 0.95 * s.coasting.ade_m);
}

TEST(LearnedPredictorOnCrowds, ItsGaussiansHoldWhatTheyPromise) {
  for (const CrowdScene scene : {CrowdScene::kDense, CrowdScene::kSparse, CrowdScene::kMixed}) {
    const PredictionScore score = scores_near_the_robot(scene, 20).told;
    EXPECT_GT(score.within_1_ratio, 0.393) << "errors have heavy tails: most are small";
    EXPECT_GT(score.within_2_ratio, 0.80) << "a Gaussian has 0.865";
    EXPECT_LT(score.within_2_ratio, 0.97) << "no wider than it need be";
  }
}

}  // namespace
}  // namespace headland
