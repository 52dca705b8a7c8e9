// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/crowd/scenario.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace headland {
namespace {

constexpr int kRuns = 2000;

TEST(CrowdScenario, SendsTheRobotAcrossTheCircle) {
  for (int run = 0; run < 50; ++run) {
    const CrowdWalk robot = crowd_scenario(1, run).robot;
    EXPECT_NEAR(robot.start.norm(), 7.5, 1e-9);
    EXPECT_EQ(robot.goal, -robot.start);
  }
}

TEST(CrowdScenario, HasTwoToElevenPeopleEquallyOften) {
  std::array<int, 12> counts{};
  for (int run = 0; run < kRuns; ++run) ++counts.at(crowd_scenario(1, run).people.size());
  EXPECT_EQ(counts[0] + counts[1], 0);
  for (std::size_t n = 2; n <= 11; ++n) EXPECT_NEAR(counts.at(n), kRuns / 10.0, 50.0) << n;
}

TEST(CrowdScenario, LetsAllBeginFreeOfEachOther) {
  for (int run = 0; run < kRuns; ++run) {
    const CrowdScenario scenario = crowd_scenario(3, run);
    std::vector<Point2> starts = {scenario.robot.start};
    for (const CrowdWalk& walk : scenario.people) starts.push_back(walk.start);
    for (std::size_t i = 0; i < starts.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) ASSERT_GE((starts[i] - starts[j]).norm(), 0.8) << run;
    }
  }
}

// Who crosses the circle goes to the opposite place; who crosses the square, to the other half.
TEST(CrowdScenario, SendsSomePeopleAcrossTheCircleAndOthersAcrossTheSquare) {
  int people = 0;
  int opposite = 0;
  for (int run = 0; run < kRuns; ++run) {
    const CrowdScenario scenario = crowd_scenario(4, run);
    for (const CrowdWalk& walk : scenario.people) {
      // Goals near the robot's were pushed away and may lie anywhere.
      if ((walk.goal - scenario.robot.goal).norm() < 5.5) continue;
      ++people;
      if ((walk.start + walk.goal).norm() < 1e-9) {
        ++opposite;
        EXPECT_NEAR(walk.start.norm(), 7.5, std::sqrt(0.5) + 1e-9);
      } else {
        EXPECT_LE(walk.start.cwiseAbs().maxCoeff(), 8.0);
        EXPECT_LE(walk.goal.cwiseAbs().maxCoeff(), 8.0);
        EXPECT_LE(walk.start.x() * walk.goal.x(), 0.0);
      }
    }
  }
  EXPECT_NEAR(static_cast<double>(opposite) / people, 0.3, 0.03);
}

TEST(CrowdScenario, LeavesTheRobotsGoalFree) {
  for (int run = 0; run < kRuns; ++run) {
    const CrowdScenario scenario = crowd_scenario(5, run);
    for (const CrowdWalk& walk : scenario.people) {
      ASSERT_GE((walk.goal - scenario.robot.goal).lpNorm<Eigen::Infinity>(), 1.5) << run;
    }
  }
}

TEST(CrowdScenario, IsTheSameForASeedAndARunAndAnotherForOthers) {
  const CrowdScenario one = crowd_scenario(1, 7);
  const CrowdScenario again = crowd_scenario(1, 7);
  ASSERT_EQ(one.people.size(), again.people.size());
  for (std::size_t i = 0; i < one.people.size(); ++i) {
    EXPECT_EQ(one.people[i].start, again.people[i].start);
    EXPECT_EQ(one.people[i].goal, again.people[i].goal);
  }
  EXPECT_NE(one.robot.start, crowd_scenario(1, 8).robot.start);
  EXPECT_NE(one.robot.start, crowd_scenario(2, 7).robot.start);
}

}  // namespace
}  // namespace headland
