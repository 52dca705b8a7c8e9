// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "local_planner/prediction/constant_velocity.hpp"
#include "local_planner/prediction/herd_predictor.hpp"
#include "local_planner/prediction/orca_predictor.hpp"

namespace headland {
namespace {

using Make = std::function<std::unique_ptr<Predictor>()>;

class AnyPredictor : public ::testing::TestWithParam<Make> {};
INSTANTIATE_TEST_SUITE_P(
    All, AnyPredictor,
    ::testing::Values([] { return std::make_unique<ConstantVelocityPredictor>(); },
                      [] { return std::make_unique<OrcaPredictor>(); },
                      [] { return std::make_unique<HerdPredictor>(); }));

std::vector<Agent> walkers(int count, double time) {
  RandomStream random(3, "walkers");
  std::vector<Agent> agents;
  for (int i = 0; i < count; ++i) {
    Agent agent;
    agent.id = count - i;
    agent.position = {random.uniform(-10.0, 10.0), random.uniform(-10.0, 10.0)};
    agent.velocity = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    agent.position += time * agent.velocity;
    agents.push_back(agent);
  }
  return agents;
}

void watch(Predictor& predictor, int count) {
  for (int k = 0; k < 5; ++k) {
    predictor.observe(walkers(count, 0.4 * k), {0.0, 0.0}, {0.0, 0.0}, 0.4 * k);
  }
}

TEST_P(AnyPredictor, GivesAGaussianForEachAgentAndStepThatWidens) {
  const auto predictor = GetParam()();
  for (const int count : {0, 1, 17, 500}) {
    watch(*predictor, count);
    Prediction p;
    predictor->predict({}, 0.4, 12, p);
    ASSERT_EQ(p.agents(), count);
    ASSERT_EQ(p.mean.size(), static_cast<std::size_t>(12 * count));
    for (int a = 0; a < count; ++a) {
      double before = 0.0;
      for (int k = 0; k < 12; ++k) {
        const Eigen::Matrix2d& c = p.covariance[p.index(a, k)];
        EXPECT_TRUE(p.mean[p.index(a, k)].allFinite());
        EXPECT_EQ(c(0, 1), c(1, 0));
        EXPECT_GT(c.determinant(), before);
        before = c.determinant();
      }
    }
  }
}

TEST_P(AnyPredictor, LeavesOutWhatIsNoNumber) {
  const auto predictor = GetParam()();
  std::vector<Agent> agents = walkers(3, 0.0);
  agents[1].position.x() = std::numeric_limits<double>::quiet_NaN();
  predictor->observe(agents, {0.0, 0.0}, {0.0, 0.0}, 0.0);
  Prediction p;
  predictor->predict({}, 0.4, 3, p);
  EXPECT_EQ(p.agents(), 2);
}

TEST_P(AnyPredictor, IsNearWhatItSawAndGoesOnAsBefore) {
  const auto predictor = GetParam()();
  const auto agent = [](double time) {
    std::vector<Agent> one(1);
    one[0].position = {3.0 + 0.8 * time, 4.0};
    return one;
  };
  for (int k = 0; k < 12; ++k) predictor->observe(agent(0.4 * k), {}, {}, 0.4 * k);
  Prediction p;
  predictor->predict({}, 0.4, 5, p);
  const double now = 3.0 + 0.8 * 4.4;
  EXPECT_NEAR(p.mean[0].x(), now + 0.32, 0.1);
  EXPECT_NEAR(p.mean[4].x(), now + 1.6, 0.2);
  EXPECT_NEAR(p.mean[4].y(), 4.0, 0.1);
}

TEST_P(AnyPredictor, ForgetsWhoIsNotSeen) {
  const auto predictor = GetParam()();
  watch(*predictor, 3);
  predictor->observe({}, {0.0, 0.0}, {0.0, 0.0}, 9.0);
  Prediction p;
  predictor->predict({}, 0.4, 3, p);
  EXPECT_EQ(p.agents(), 0);
}

TEST(OrcaPredictor, ExpectsPeopleToGiveWayToTheRobotsPath) {
  OrcaPredictor predictor;
  ConstantVelocityPredictor straight;
  Agent agent;
  agent.position = {8.0, 0.2};
  agent.velocity = {-1.0, 0.0};
  predictor.observe({&agent, 1}, {0.0, 0.0}, {1.0, 0.0}, 0.0);
  std::vector<Point2> towards;
  for (int k = 1; k <= 10; ++k) towards.emplace_back(0.4 * k, 0.0);
  Prediction reacting;
  Prediction standing;
  predictor.predict(towards, 0.4, 10, reacting);
  predictor.predict({}, 0.4, 10, standing);
  EXPECT_GT(reacting.mean[9].y(), 0.6);
  EXPECT_GT(reacting.mean[9].y(), standing.mean[9].y() + 0.2);
}

TEST(OrcaPredictor, PartsTwoPeopleOnACourseOfCollision) {
  OrcaPredictor predictor;
  std::vector<Agent> two(2);
  two[0].position = {5.0, 5.0};
  two[0].velocity = {1.0, 0.0};
  two[1].id = 1;
  two[1].position = {9.0, 5.1};
  two[1].velocity = {-1.0, 0.0};
  predictor.observe(two, {0.0, 0.0}, {0.0, 0.0}, 0.0);
  Prediction p;
  predictor.predict({}, 0.2, 20, p);
  for (int k = 0; k < 20; ++k) {
    EXPECT_GT((p.mean[p.index(0, k)] - p.mean[p.index(1, k)]).norm(), 0.59) << k;
  }
}

}  // namespace
}  // namespace headland
