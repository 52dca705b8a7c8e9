// SPDX-License-Identifier: Apache-2.0
// The weights that are shipped: what libtorch makes of them, and what they have learnt.
#include <fstream>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "local_planner/prediction/learned_predictor.hpp"

namespace headland {
namespace {

const ResponseNetwork& shipped() {
  static const ResponseNetwork kNetwork = [] {
    auto network = load_network(HEADLAND_SOURCE_DIR "/config/models/crowd_response.weights");
    if (!network) throw std::runtime_error(to_string(network.error()));
    return *std::move(network);
  }();
  return kNetwork;
}

// ---- As libtorch computes it

struct ReferenceAgent {
  double radius_m = 0.0;
  std::vector<Point2> position;
  std::vector<Point2> velocity;
  std::vector<Point2> mean;
  std::vector<Eigen::Matrix2d> covariance;
};

struct ReferenceWindow {
  double robot_radius_m = 0.0;
  std::vector<Point2> robot;
  std::vector<ReferenceAgent> agents;
};

struct Reference {
  int past = 0;
  int future = 0;
  double step_s = 0.0;
  std::vector<ReferenceWindow> windows;
};

Reference read_reference() {
  std::ifstream in(HEADLAND_SOURCE_DIR "/tests/local_planner/prediction/crowd_response.reference");
  std::string word;
  const auto point = [&] {
    Point2 p;
    in >> p.x() >> p.y();
    return p;
  };
  Reference reference;
  std::size_t windows = 0;
  in >> word >> windows >> word >> reference.past >> word >> reference.future >> word >>
      reference.step_s;
  for (std::size_t w = 0; w < windows && in; ++w) {
    ReferenceWindow window;
    int agents = 0;
    in >> word >> window.robot_radius_m >> word >> agents >> word;
    for (int k = 0; k <= reference.past + reference.future; ++k) window.robot.push_back(point());
    for (int a = 0; a < agents; ++a) {
      ReferenceAgent agent;
      in >> word >> agent.radius_m;
      for (int k = 0; k <= reference.past; ++k) {
        agent.position.push_back(point());
        agent.velocity.push_back(point());
      }
      in >> word;
      for (int k = 0; k < reference.future; ++k) {
        agent.mean.push_back(point());
        Eigen::Matrix2d c;
        in >> c(0, 0) >> c(0, 1) >> c(1, 1);
        c(1, 0) = c(0, 1);
        agent.covariance.push_back(c);
      }
      window.agents.push_back(agent);
    }
    reference.windows.push_back(window);
  }
  EXPECT_TRUE(in) << "the reference is cut short";
  return reference;
}

TEST(CrowdResponse, PredictsWhatLibtorchPredictsFromTheSameWeights) {
  const Reference reference = read_reference();
  ASSERT_EQ(reference.windows.size(), 8U);
  int compared = 0;
  for (const ReferenceWindow& window : reference.windows) {
    LearnedPredictor predictor(shipped(), window.robot_radius_m);
    for (int k = 0; k <= reference.past; ++k) {
      const auto at = static_cast<std::size_t>(k);
      std::vector<Agent> agents;
      for (const ReferenceAgent& from : window.agents) {
        Agent agent;
        agent.id = static_cast<int>(agents.size());
        agent.position = from.position[at];
        agent.velocity = from.velocity[at];
        agent.radius_m = from.radius_m;
        agents.push_back(agent);
      }
      predictor.observe(agents, window.robot[at], {0.0, 0.0}, k * reference.step_s);
    }
    const std::vector<Point2> path(window.robot.begin() + reference.past + 1, window.robot.end());
    Prediction prediction;
    predictor.predict(path, reference.step_s, reference.future, prediction);
    ASSERT_EQ(static_cast<std::size_t>(prediction.agents()), window.agents.size());
    for (int a = 0; a < prediction.agents(); ++a) {
      const ReferenceAgent& wanted = window.agents[static_cast<std::size_t>(a)];
      for (int s = 0; s < prediction.steps; ++s, ++compared) {
        const std::size_t i = prediction.index(a, s);
        const auto step = static_cast<std::size_t>(s);
        ASSERT_LT((prediction.mean[i] - wanted.mean[step]).norm(), 1e-3);
        ASSERT_LT((prediction.covariance[i] - wanted.covariance[step]).norm(),
                  1e-3 * wanted.covariance[step].norm() + 1e-6);
      }
    }
  }
  EXPECT_GT(compared, 300);
}

// ---- What it has learnt

Agent walking(int id, const Point2& position, const Point2& velocity) {
  Agent agent;
  agent.id = id;
  agent.position = position;
  agent.velocity = velocity;
  agent.radius_m = 0.5;
  return agent;
}

// One person comes along the x axis at 1 m/s and is at the origin now; the robot stands at `robot`.
LearnedPredictor person_meets_robot_at(const Point2& robot) {
  LearnedPredictor predictor(shipped(), 1.5);
  for (int k = -30; k <= 0; ++k) {
    const double t = 0.1 * k;
    const Agent person[] = {walking(1, {t, 0.0}, {1.0, 0.0})};
    predictor.observe(person, robot, {0.0, 0.0}, t);
  }
  return predictor;
}

Prediction predicted(const LearnedPredictor& predictor, const Point2& from,
                     const Point2& velocity) {
  std::vector<Point2> path;
  for (int k = 1; k <= 12; ++k) path.push_back(from + 0.4 * k * velocity);
  Prediction prediction;
  predictor.predict(path, 0.4, 12, prediction);
  return prediction;
}

TEST(CrowdResponse, WhoIsAloneWalksOn) {
  const LearnedPredictor predictor = person_meets_robot_at({100.0, 0.0});
  const Prediction p = predicted(predictor, {100.0, 0.0}, {0.0, 0.0});
  for (int s = 0; s < 12; ++s) {
    EXPECT_LT((p.mean[p.index(0, s)] - Point2(0.4 * (s + 1), 0.0)).norm(), 0.08 * (s + 1));
  }
}

TEST(CrowdResponse, ARobotsPathThroughAnAgentBendsItsPrediction) {
  // From the side, the robot drives to where the person will be in 3 s, or drives off.
  const Point2 robot(3.0, -4.0);
  const LearnedPredictor predictor = person_meets_robot_at(robot);
  const Prediction meets = predicted(predictor, robot, {0.0, 1.3});
  const Prediction leaves = predicted(predictor, robot, {0.0, -1.3});
  double most = 0.0;
  double nearest_meeting = 1e9;
  double nearest_ignoring = 1e9;
  for (int s = 0; s < 12; ++s) {
    const std::size_t i = meets.index(0, s);
    const Point2 then = robot + 0.4 * (s + 1) * Point2(0.0, 1.3);
    most = std::max(most, (meets.mean[i] - leaves.mean[i]).norm());
    nearest_meeting = std::min(nearest_meeting, (meets.mean[i] - then).norm());
    nearest_ignoring = std::min(nearest_ignoring, (leaves.mean[i] - then).norm());
  }
  EXPECT_GT(most, 0.5);
  EXPECT_GT(nearest_meeting, nearest_ignoring + 0.3) << "it gives way";
}

TEST(CrowdResponse, APersonEvadesARobotInItsWayToTheNearerSide) {
  for (const double side : {-1.0, 1.0}) {
    const Point2 robot(4.0, 0.6 * side);
    const Prediction p = predicted(person_meets_robot_at(robot), robot, {0.0, 0.0});
    EXPECT_LT(side * p.mean[p.index(0, 7)].y(), -0.2) << side;
  }
}

TEST(CrowdResponse, AgentsGiveWayToEachOther) {
  LearnedPredictor predictor(shipped(), 1.5);
  for (int k = -30; k <= 0; ++k) {
    const double t = 0.1 * k;
    const Agent two[] = {walking(1, {t - 2.0, 0.15}, {1.0, 0.0}),
                         walking(2, {2.0 - t, -0.15}, {-1.0, 0.0})};
    predictor.observe(two, {50.0, 50.0}, {0.0, 0.0}, t);
  }
  const Prediction p = predicted(predictor, {50.0, 50.0}, {0.0, 0.0});
  double nearest = 1e9;
  for (int s = 0; s < 12; ++s) {
    nearest = std::min(nearest, (p.mean[p.index(0, s)] - p.mean[p.index(1, s)]).norm());
  }
  EXPECT_GT(nearest, 0.6) << "0.3 m if both went on; 1.0 m is contact";
}

TEST(CrowdResponse, UncertaintyGrowsWithTime) {
  const Prediction alone = predicted(person_meets_robot_at({100.0, 0.0}), {100.0, 0.0}, {0.0, 0.0});
  const Prediction near = predicted(person_meets_robot_at({4.0, 0.0}), {4.0, 0.0}, {0.0, 0.0});
  const auto u = [](const Prediction& p, int step) {
    return std::sqrt(p.covariance[p.index(0, step)].determinant());
  };
  EXPECT_GT(u(alone, 11), 2.0 * u(alone, 5));
  EXPECT_GT(u(near, 11), 2.0 * u(near, 5));
}

}  // namespace
}  // namespace headland
