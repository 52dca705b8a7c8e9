// SPDX-License-Identifier: Apache-2.0
#include "core/world/clearance_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

Polygon box(double left, double low, double right, double high) {
  return {{{left, low}, {right, low}, {right, high}, {left, high}}, {}};
}

TEST(ClearanceMap, IsNeverMoreThanTheTrueDistanceAndHardlyLess) {
  RandomStream random(1, "clearance");
  const double cell = 0.2;
  std::vector<std::uint8_t> blocked(60 * 50);
  std::vector<Point2> centres;
  for (std::size_t i = 0; i < blocked.size(); ++i) {
    blocked[i] = random.uniform() < 0.01 ? 1 : 0;
    if (blocked[i] != 0) {
      centres.emplace_back(1.0 + cell * (static_cast<double>(i % 60) + 0.5),
                           2.0 + cell * (static_cast<double>(i / 60) + 0.5));
    }
  }
  const ClearanceMap map({1.0, 2.0}, cell, 60, 50, blocked);
  for (int k = 0; k < 2000; ++k) {
    const Point2 p(random.uniform(1.0, 13.0), random.uniform(2.0, 12.0));
    double exact = 1e9;
    for (const Point2& c : centres) {
      const Point2 off = (p - c).cwiseAbs() - Point2(0.5 * cell, 0.5 * cell);
      exact = std::min(exact, off.cwiseMax(0.0).norm());
    }
    EXPECT_LE(map.clearance(p), exact + 1e-6);
    EXPECT_GE(map.clearance(p), exact - 2.9 * cell);
  }
}

TEST(ClearanceMap, WithoutObstaclesEverythingIsFarAway) {
  EXPECT_EQ(ClearanceMap().clearance({1e7, 0.0}), ClearanceMap::kFar);
  EXPECT_TRUE(ClearanceMap().disc_passes({0.0, 0.0}, {1e6, 0.0}, 5.0));
}

TEST(ClearanceMap, ADiscPassesAGapThatIsWideEnough) {
  const ClearanceMap map = ClearanceMap::of({box(0, -5, 1, -1.5), box(0, 1.5, 1, 5)}, 0.1);
  EXPECT_TRUE(map.disc_passes({-3.0, 0.0}, {4.0, 0.0}, 1.0));
  EXPECT_FALSE(map.disc_passes({-3.0, 0.0}, {4.0, 0.0}, 1.6));
  EXPECT_FALSE(map.disc_passes({-3.0, 2.5}, {4.0, 2.5}, 0.1));
}

TEST(ClearanceMap, OutsideTheFreeAreaIsAnObstacle) {
  const ClearanceMap map = ClearanceMap::around({box(0, 0, 20, 10)});
  EXPECT_NEAR(map.clearance({10.0, 5.0}), 5.0, 0.6);
  EXPECT_EQ(map.clearance({-0.5, 5.0}), 0.0);
}

TEST(ClearanceMap, PointsAwayFromTheNearestObstacle) {
  const ClearanceMap map = ClearanceMap::of({box(0, 0, 1, 1)});
  EXPECT_GT(map.away({3.0, 0.5}).x(), 0.9);
  EXPECT_GT(map.away({0.5, -3.0}).dot(Point2(0.0, -1.0)), 0.9);
}

TEST(ClearanceMap, AnswersOffItsGridAndForNoNumber) {
  const ClearanceMap map = ClearanceMap::of({box(0, 0, 1, 1)}, 0.2, 5.0);
  EXPECT_GT(map.clearance({100.0, 0.0}), 50.0);
  EXPECT_LT(map.clearance({100.0, 0.0}), 99.01);
  EXPECT_EQ(map.clearance({std::numeric_limits<double>::quiet_NaN(), 0.0}), 0.0);
}

}  // namespace
}  // namespace headland
