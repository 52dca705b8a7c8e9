// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/prediction/crowd_windows.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace headland {
namespace {

TEST(CrowdWindows, HoldWhatTheShapeAsksFor) {
  const WindowShape shape{0.4, 5, 8, 6, 9.0};
  for (const auto& [scene, name] : config::EnumNames<CrowdScene>::values) {
    const auto windows = record_windows(scene, shape, 4, 1);
    ASSERT_GT(windows.size(), 5U) << name;
    for (const CrowdWindow& window : windows) {
      const auto moments = static_cast<std::size_t>(shape.moments());
      const auto agents = static_cast<std::size_t>(window.agents());
      ASSERT_EQ(moments, 14U);
      ASSERT_EQ(window.robot.size(), moments);
      ASSERT_GE(agents, 1U);
      ASSERT_LE(agents, 6U);
      ASSERT_EQ(window.position.size(), agents * moments);
      ASSERT_EQ(window.velocity.size(), agents * moments);
      double before = 0.0;
      for (std::size_t i = 0; i < agents; ++i) {  // nearest first
        const double distance = (window.position[i * moments + 5] - window.robot[5]).norm();
        ASSERT_LT(distance, 9.0);
        ASSERT_GE(distance, before);
        before = distance;
      }
    }
  }
}

TEST(CrowdWindows, VelocitiesAreThoseOfTheWay) {
  const WindowShape shape{0.1, 3, 10, 12, 10.0};  // of the simulator's own steps
  for (const CrowdWindow& window : record_windows(CrowdScene::kDense, shape, 1, 2)) {
    const auto moments = static_cast<std::size_t>(shape.moments());
    for (std::size_t i = 1; i < moments; ++i) {
      ASSERT_NEAR((window.position[i] - window.position[i - 1] - 0.1 * window.velocity[i]).norm(),
                  0.0, 1e-9);
    }
  }
}

TEST(CrowdWindows, CrowdsAreWhatTheirNamesSay) {
  const WindowShape shape;
  for (const CrowdWindow& window : record_windows(CrowdScene::kCrossing, shape, 5, 3)) {
    EXPECT_NEAR(window.robot_radius_m, 0.3, 1e-12);
    for (const double radius : window.radius_m) EXPECT_NEAR(radius, 0.3, 1e-12);
    for (const Point2& velocity : window.velocity) EXPECT_LE(velocity.norm(), 1.0 + 1e-9);
  }
  const auto mean_agents = [&](CrowdScene scene) {
    double sum = 0.0;
    const auto windows = record_windows(scene, {0.4, 7, 12, 100, 10.0}, 6, 3);
    for (const CrowdWindow& window : windows) {
      EXPECT_EQ(window.robot_radius_m, 1.5);
      for (const Point2& velocity : window.velocity) EXPECT_LE(velocity.norm(), 1.5 + 1e-9);
      sum += window.agents();
    }
    return sum / static_cast<double>(windows.size());
  };
  // A disc of 10 m holds 31 and 6.3 if all are spread evenly; those who walk from goal to goal are
  // up to twice as dense in the middle, where the robot is.
  const double dense = mean_agents(CrowdScene::kDense);
  const double sparse = mean_agents(CrowdScene::kSparse);
  EXPECT_GT(dense, 31.0);
  EXPECT_LT(dense, 62.0);
  EXPECT_GT(sparse, 6.3);
  EXPECT_LT(sparse, 12.6);
}

TEST(CrowdWindows, TheSameSeedGivesTheSameWindows) {
  const auto all = [](std::uint64_t seed) {
    std::vector<Point2> points;
    for (const CrowdWindow& window : record_windows(CrowdScene::kMixed, {}, 2, seed)) {
      points.insert(points.end(), window.robot.begin(), window.robot.end());
      points.insert(points.end(), window.position.begin(), window.position.end());
    }
    return points;
  };
  EXPECT_EQ(all(4), all(4));
  EXPECT_NE(all(4), all(5));
}

}  // namespace
}  // namespace headland
