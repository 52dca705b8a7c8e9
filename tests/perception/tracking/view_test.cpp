// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/view.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace headland {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SensorView, SeesWhatIsInRange) {
  SensorView view;
  view.sensor = {5.0, 5.0};
  view.far_m = 20.0;
  EXPECT_EQ(view.visible_share({15.0, 5.0}, 0.3), 1.0);
  EXPECT_EQ(view.visible_share({26.0, 5.0}, 0.3), 0.0);
  EXPECT_EQ(view.visible_share({5.2, 5.0}, 0.3), 0.0);
}

TEST(SensorView, ABlindSectorAcrossThePositiveAndNegativeHalfTurnHides) {
  SensorView view;
  view.hidden.push_back({kPi - 0.5, 1.0, 0.0});
  EXPECT_EQ(view.visible_share({-10.0, 0.1}, 0.3), 0.0);
  EXPECT_EQ(view.visible_share({-10.0, -0.1}, 0.3), 0.0);
  EXPECT_EQ(view.visible_share({10.0, 0.0}, 0.3), 1.0);
}

TEST(SensorView, AShadowHidesWhatIsBehindAndNotWhatIsBefore) {
  SensorView view;
  view.hidden.push_back(shadow_of({0.0, 0.0}, {5.0, 0.0}, 1.0, 0.5));
  EXPECT_EQ(view.visible_share({10.0, 0.0}, 0.3), 0.0);
  EXPECT_EQ(view.visible_share({4.0, 0.0}, 0.3), 1.0);
  EXPECT_EQ(view.visible_share({10.0, 3.0}, 0.3), 1.0);
}

TEST(SensorView, AtTheEdgeOfAShadowHalfIsSeen) {
  SensorView view;
  const double edge = std::atan2(0.5, 5.0);
  view.hidden.push_back(shadow_of({0.0, 0.0}, {5.0, 0.0}, 1.0, 0.5));
  const Point2 at_edge(10.0 * std::cos(edge), 10.0 * std::sin(edge));
  EXPECT_NEAR(view.visible_share(at_edge, 0.3), 0.5, 0.12);
}

TEST(SensorView, NoNumbersAreNotSeen) {
  SensorView view;
  EXPECT_EQ(view.visible_share({kNan, 0.0}, 0.3), 0.0);
  EXPECT_EQ(view.visible_share({5.0, 0.0}, kNan), 0.0);
  view.sensor = {kNan, 0.0};
  EXPECT_EQ(view.visible_share({5.0, 0.0}, 0.3), 0.0);
}

TEST(AddShadows, AWallHidesWhatIsBehindItAndIsOneArc) {
  SensorView view;
  std::vector<Point2> wall;
  for (int i = -50; i <= 50; ++i) {
    const double azimuth = 1.0 + 0.005 * i;
    wall.emplace_back(8.0 * std::cos(azimuth), 8.0 * std::sin(azimuth));
  }
  wall.emplace_back(kNan, 0.0);
  add_shadows(wall, 0.3, 360, view);
  EXPECT_EQ(view.hidden.size(), 1u);
  EXPECT_EQ(view.visible_share({12.0 * std::cos(1.0), 12.0 * std::sin(1.0)}, 0.3), 0.0);
  EXPECT_EQ(view.visible_share({6.0 * std::cos(1.0), 6.0 * std::sin(1.0)}, 0.3), 1.0);
  EXPECT_EQ(view.visible_share({12.0, -3.0}, 0.3), 1.0);
}

TEST(AddShadows, NoPointsHideNothing) {
  SensorView view;
  add_shadows({}, 0.3, 360, view);
  add_shadows(std::vector<Point2>{{5.0, 0.0}}, 0.3, 0, view);
  EXPECT_TRUE(view.hidden.empty());
}

}  // namespace
}  // namespace headland
