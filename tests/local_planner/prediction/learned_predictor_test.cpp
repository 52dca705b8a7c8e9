// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/learned_predictor.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "tests/local_planner/prediction/random_network.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kStep = 0.4;
constexpr int kSteps = 12;

Agent agent_at(int id, const Point2& position, const Point2& velocity) {
  Agent agent;
  agent.id = id;
  agent.position = position;
  agent.velocity = velocity;
  agent.radius_m = 0.5;
  return agent;
}

// A few agents on straight lines around a robot that drives along a line, turned about the origin.
struct Scene {
  double turn = 0.0;
  Point2 shift{0.0, 0.0};

  Point2 map(const Point2& p) const { return Eigen::Rotation2Dd(turn) * p + shift; }
  Point2 map_vector(const Point2& v) const { return Eigen::Rotation2Dd(turn) * v; }
  Point2 robot(double time) const { return map({0.8 * time, 0.1 * time}); }
  std::vector<Agent> agents(double time) const {
    const Point2 start[] = {{4.0, 1.0}, {2.0, -3.0}, {-3.0, 0.5}, {6.0, 0.0}};
    const Point2 velocity[] = {{-0.6, 0.1}, {0.2, 0.9}, {1.2, 0.0}, {-1.0, -0.2}};
    std::vector<Agent> all;
    for (int i = 0; i < 4; ++i) {
      all.push_back(agent_at(i + 7, map(start[i] + time * velocity[i]), map_vector(velocity[i])));
    }
    return all;
  }
  void show(Predictor& predictor, double from, double to, double every) const {
    for (double t = from; t <= to + 1e-9; t += every) {
      predictor.observe(agents(t), robot(t), map_vector({0.8, 0.1}), t);
    }
  }
  std::vector<Point2> path(double now, double step = kStep, int steps = kSteps) const {
    std::vector<Point2> places;
    for (int k = 1; k <= steps; ++k) places.push_back(robot(now + k * step));
    return places;
  }
};

Prediction predicted(const Predictor& predictor, const std::vector<Point2>& path,
                     double step = kStep, int steps = kSteps) {
  Prediction prediction;
  predictor.predict(path, step, steps, prediction);
  return prediction;
}

double farthest(const Prediction& a, const Prediction& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.mean.size(); ++i) {
    most = std::max(most, (a.mean[i] - b.mean[i]).norm());
  }
  return most;
}

TEST(LearnedPredictor, AnswersForAllAgentsOfTheLastSight) {
  LearnedPredictor predictor(testing::random_network(1));
  Scene().show(predictor, 0.0, 3.0, 0.1);
  const Prediction prediction = predicted(predictor, {}, 0.25, 20);
  EXPECT_TRUE(predictor.reacts());
  EXPECT_EQ(prediction.ids, (std::vector<int>{7, 8, 9, 10}));
  EXPECT_EQ(prediction.steps, 20);
  EXPECT_EQ(prediction.step_s, 0.25);
  EXPECT_EQ(prediction.mean.size(), 80U);
  EXPECT_EQ(prediction.covariance.size(), 80U);
  EXPECT_EQ(prediction.radius_m, (std::vector<double>(4, 0.5)));
}

TEST(LearnedPredictor, CovariancesArePositiveDefiniteAndNeverShrink) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    LearnedPredictor predictor(testing::random_network(seed, 8, 1.5F));
    const Scene scene;
    scene.show(predictor, 0.0, 3.0, 0.1);
    const Prediction p = predicted(predictor, scene.path(3.0));
    for (int a = 0; a < p.agents(); ++a) {
      Eigen::Matrix2d before = Eigen::Matrix2d::Zero();
      for (int s = 0; s < p.steps; ++s) {
        const Eigen::Matrix2d& now = p.covariance[p.index(a, s)];
        const Eigen::Vector2d grown =
            Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(now - before).eigenvalues();
        ASSERT_TRUE(p.mean[p.index(a, s)].allFinite());
        ASSERT_GT(grown.minCoeff(), 0.0) << "seed " << seed << " step " << s;
        before = now;
      }
    }
  }
}

TEST(LearnedPredictor, ANetworkThatSaysNothingIsOneOfConstantVelocity) {
  ResponseNetwork network = testing::random_network(2);
  network.head.weight.setZero();
  network.head.bias.setZero();
  LearnedPredictor predictor(network);
  const Scene scene;
  scene.show(predictor, 0.0, 3.0, 0.1);
  const Prediction p = predicted(predictor, scene.path(3.0));
  for (int a = 0; a < p.agents(); ++a) {
    for (int s = 0; s < p.steps; ++s) {
      const Agent then = scene.agents(3.0 + (s + 1) * kStep)[static_cast<std::size_t>(a)];
      EXPECT_LT((p.mean[p.index(a, s)] - then.position).norm(), 1e-4);
    }
  }
}

TEST(LearnedPredictor, ATurnedAndShiftedSceneGivesATurnedAndShiftedPrediction) {
  const Scene here;
  const Scene there{2.3, {5000.0, -700.0}};
  LearnedPredictor a(testing::random_network(3));
  LearnedPredictor b(testing::random_network(3));
  here.show(a, 0.0, 3.0, 0.1);
  there.show(b, 0.0, 3.0, 0.1);
  const Prediction p = predicted(a, here.path(3.0));
  const Prediction q = predicted(b, there.path(3.0));
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(there.turn).toRotationMatrix();
  for (std::size_t i = 0; i < p.mean.size(); ++i) {
    EXPECT_LT((there.map(p.mean[i]) - q.mean[i]).norm(), 1e-3);
    EXPECT_LT((turn * p.covariance[i] * turn.transpose() - q.covariance[i]).norm(),
              1e-3 * q.covariance[i].norm());
  }
}

TEST(LearnedPredictor, SightsMayComeAtAnyPace) {
  LearnedPredictor often(testing::random_network(4));
  LearnedPredictor seldom(testing::random_network(4));
  LearnedPredictor unevenly(testing::random_network(4));
  const Scene scene;
  scene.show(often, 0.0, 4.0, 0.02);
  scene.show(seldom, 0.0, 4.0, 0.4);
  for (const double t : {0.0, 0.31, 0.9, 1.0, 1.7, 2.05, 2.9, 3.33, 4.0}) {
    unevenly.observe(scene.agents(t), scene.robot(t), {0.8, 0.1}, t);
  }
  const auto path = scene.path(4.0);
  EXPECT_LT(farthest(predicted(often, path), predicted(seldom, path)), 1e-3);
  EXPECT_LT(farthest(predicted(unevenly, path), predicted(seldom, path)), 1e-3);
}

TEST(LearnedPredictor, StepsOfOtherLengthsLieOnTheSameWay) {
  LearnedPredictor predictor(testing::random_network(5));
  const Scene scene;
  scene.show(predictor, 0.0, 3.0, 0.1);
  const Prediction coarse = predicted(predictor, scene.path(3.0));
  const Prediction fine = predicted(predictor, scene.path(3.0, 0.1, 48), 0.1, 48);
  for (int a = 0; a < 4; ++a) {
    for (int s = 0; s < kSteps; ++s) {
      const std::size_t i = coarse.index(a, s), j = fine.index(a, 4 * s + 3);
      EXPECT_LT((coarse.mean[i] - fine.mean[j]).norm(), 1e-4);
      EXPECT_LT((coarse.covariance[i] - fine.covariance[j]).norm(), 1e-4);
    }
  }
}

TEST(LearnedPredictor, AShortPathMeansThatTheRobotStays) {
  LearnedPredictor predictor(testing::random_network(6));
  const Scene scene;
  scene.show(predictor, 0.0, 3.0, 0.1);
  const std::vector<Point2> standing(kSteps, scene.robot(3.0));
  EXPECT_EQ(farthest(predicted(predictor, {}), predicted(predictor, standing)), 0.0);
  std::vector<Point2> moves = scene.path(3.0);
  std::vector<Point2> cut(moves.begin(), moves.begin() + 4);
  for (std::size_t k = 4; k < moves.size(); ++k) moves[k] = moves[3];
  EXPECT_EQ(farthest(predicted(predictor, cut), predicted(predictor, moves)), 0.0);
  EXPECT_GT(farthest(predicted(predictor, cut), predicted(predictor, {})), 1e-4);
}

TEST(LearnedPredictor, BadNumbersLeaveAnAgentOutAndHarmNoOther) {
  const Scene scene;
  LearnedPredictor clean(testing::random_network(7));
  LearnedPredictor dirty(testing::random_network(7));
  for (double t = 0.0; t < 3.05; t += 0.1) {
    std::vector<Agent> agents = scene.agents(t);
    clean.observe(agents, scene.robot(t), {0.8, 0.1}, t);
    agents.push_back(agent_at(20, {kNan, 0.0}, {0.0, 0.0}));
    agents.push_back(agent_at(21, {0.0, 1e300}, {0.0, 0.0}));
    agents.push_back(agent_at(22, {1.0, 1.0}, {0.0, kNan}));
    agents.insert(agents.begin(), agent_at(23, {1.0, 1.0}, {0.0, 0.0}));
    agents.front().radius_m = kNan;
    dirty.observe(agents, scene.robot(t), {0.8, 0.1}, t);
  }
  dirty.observe(scene.agents(9.0), scene.robot(9.0), {0.8, 0.1}, kNan);
  const auto path = scene.path(3.0);
  EXPECT_EQ(predicted(dirty, path).ids, predicted(clean, path).ids);
  EXPECT_EQ(farthest(predicted(dirty, path), predicted(clean, path)), 0.0);
}

TEST(LearnedPredictor, WildNumbersOfAgentsAndRobotGiveFinitePredictions) {
  LearnedPredictor predictor(testing::random_network(8, 8, 3.0F));
  const Agent wild[] = {agent_at(1, {0.0, 0.0}, {1e200, -1e200}),
                        agent_at(2, {0.0, 0.0}, {0.0, 0.0}), agent_at(2, {1.0, 0.0}, {1.0, 0.0}),
                        agent_at(3, {1e7, -1e7}, {1e30, 0.0})};
  for (const double t : {0.0, 0.1, 0.1, 0.5}) {
    predictor.observe(wild, {0.0, 0.0}, {1e300, 0.0}, t);
  }
  for (const Point2& target : {Point2(1e300, 0.0), Point2(kNan, 0.0), Point2(1e9, 1e9)}) {
    const Prediction p = predicted(predictor, {target, target});
    EXPECT_EQ(p.agents(), 3);
    for (const Point2& mean : p.mean) EXPECT_TRUE(mean.allFinite());
    for (const Eigen::Matrix2d& covariance : p.covariance) EXPECT_TRUE(covariance.allFinite());
  }
  EXPECT_EQ(predicted(predictor, {}, kNan).mean.size(), 0U);
  EXPECT_EQ(predicted(predictor, {}, 0.4, -3).steps, 0);
  predictor.observe(wild, {kNan, 0.0}, {0.0, 0.0}, 0.6);
  EXPECT_EQ(predicted(predictor, {}).agents(), 3);
}

TEST(LearnedPredictor, WhoIsNotSeenIsNotPredictedAndForgottenAfterASecond) {
  const Scene scene;
  LearnedPredictor predictor(testing::random_network(9));
  scene.show(predictor, 0.0, 3.0, 0.1);
  std::vector<Agent> others = scene.agents(3.0);
  others.pop_back();
  for (double t = 3.1; t < 6.95; t += 0.1) predictor.observe(others, scene.robot(t), {0.8, 0.1}, t);
  EXPECT_EQ(predicted(predictor, {}).ids, (std::vector<int>{7, 8, 9}));
  // Back again, the fourth is new: it is predicted as one that was never seen before.
  LearnedPredictor fresh(testing::random_network(9));
  for (double t = 2.0; t < 6.95; t += 0.1) fresh.observe(others, scene.robot(t), {0.8, 0.1}, t);
  predictor.observe(scene.agents(7.0), scene.robot(7.0), {0.8, 0.1}, 7.0);
  fresh.observe(scene.agents(7.0), scene.robot(7.0), {0.8, 0.1}, 7.0);
  EXPECT_LT(farthest(predicted(predictor, {}), predicted(fresh, {})), 1e-5);
}

TEST(LearnedPredictor, TimeThatRunsBackBeginsAnotherRun) {
  const Scene scene;
  LearnedPredictor used(testing::random_network(10));
  LearnedPredictor fresh(testing::random_network(10));
  Scene{1.0, {3.0, 3.0}}.show(used, 50.0, 53.0, 0.1);
  scene.show(used, 0.0, 1.0, 0.1);
  scene.show(fresh, 0.0, 1.0, 0.1);
  EXPECT_EQ(farthest(predicted(used, {}), predicted(fresh, {})), 0.0);
}

TEST(LearnedPredictor, VelocitiesThatAreNotObservedComeFromTheWay) {
  const Scene scene;
  LearnedPredictor told(testing::random_network(11));
  LearnedPredictor untold(testing::random_network(11));
  for (double t = 0.0; t < 6.05; t += 0.1) {
    std::vector<Agent> agents = scene.agents(t);
    told.observe(agents, scene.robot(t), {0.8, 0.1}, t);
    for (Agent& agent : agents) agent.velocity.setZero();
    untold.observe(agents, scene.robot(t), {0.8, 0.1}, t);
  }
  EXPECT_LT(farthest(predicted(told, {}), predicted(untold, {})), 1e-3);
}

TEST(LearnedPredictor, DoesNotAllocateOnceItHasSeenAsManyAgents) {
  const Scene scene;
  LearnedPredictor predictor(testing::random_network(12));
  const auto path = scene.path(3.0);
  Prediction prediction;
  std::vector<std::vector<Agent>> sights;
  for (int i = 0; i < 60; ++i) sights.push_back(scene.agents(0.1 * i));
  long before = 0;
  for (int i = 0; i < 60; ++i) {
    if (i == 30) before = testing::allocation_count();
    predictor.observe(sights[static_cast<std::size_t>(i)], scene.robot(0.1 * i), {0.8, 0.1},
                      0.1 * i);
    predictor.predict(path, kStep, kSteps, prediction);
  }
  EXPECT_EQ(testing::allocation_count(), before);
}

TEST(LearnedPredictor, ARadiusThatIsNoneIsRefused) {
  EXPECT_THROW(LearnedPredictor(testing::random_network(13), -1.0), std::invalid_argument);
  EXPECT_THROW(LearnedPredictor(testing::random_network(13), kNan), std::invalid_argument);
}

}  // namespace
}  // namespace headland
