// SPDX-License-Identifier: Apache-2.0
#include "local_planner/cost_to_go.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "core/geometry/dubins.hpp"

namespace headland {
namespace {

// The shortest Dubins path to any of many poses on the disc's rim.
double by_search(const Pose2& from, const Point2& place, double accuracy, double radius) {
  constexpr int kAngles = 72;
  double best = 1e9;
  for (int k = 0; k < kAngles; ++k) {
    const double at = 2.0 * kPi * k / kAngles;
    const Point2 rim = place + accuracy * Point2(std::cos(at), std::sin(at));
    for (int m = 0; m < kAngles; ++m) {
      best =
          std::min(best, dubins_length(from, {rim.x(), rim.y(), 2.0 * kPi * m / kAngles}, radius));
    }
  }
  return best;
}

TEST(CostToGo, IsTheShortestDubinsPathToTheDisc) {
  RandomStream random(1, "cost to go");
  int close = 0;
  int count = 0;
  for (int i = 0; i < 150; ++i) {
    const Pose2 from{0.0, 0.0, random.uniform(-kPi, kPi)};
    const Point2 place(random.uniform(-8.0, 8.0), random.uniform(-8.0, 8.0));
    const double radius = random.uniform(0.5, 3.0);
    const double accuracy = random.uniform(0.1, 1.5);
    if (place.norm() < accuracy + 0.3) continue;
    const double ours = forward_distance(from, place, accuracy, radius);
    const double best = by_search(from, place, accuracy, radius);
    EXPECT_LE(ours, 1.2 * best + 0.05) << i;
    EXPECT_GE(ours, 0.98 * best - 0.15) << i;
    ++count;
    if (std::abs(ours - best) < 0.02 * best + 0.1) ++close;
  }
  EXPECT_GT(close, count * 9 / 10);
}

TEST(CostToGo, APlaceBesideTheVehicleIsADetour) {
  // Inside the turning circle: 1 m to the left with a radius of 2 m.
  EXPECT_GT(forward_distance({}, {0.0, 1.0}, 0.2, 2.0), 6.0);
  EXPECT_NEAR(forward_distance({}, {0.0, 4.0}, 0.0, 2.0), 2.0 * kPi, 1e-9);
  EXPECT_NEAR(forward_distance({}, {5.0, 0.0}, 1.0, 2.0), 4.0, 1e-9);
}

TEST(CostToGo, IsZeroInsideTheDiscAndStraightWithoutARadius) {
  EXPECT_EQ(forward_distance({1.0, 1.0, 2.0}, {1.2, 1.0}, 0.5, 2.0), 0.0);
  EXPECT_NEAR(forward_distance({}, {-3.0, 4.0}, 1.0, 0.0), 4.0, 1e-12);
}

}  // namespace
}  // namespace headland
