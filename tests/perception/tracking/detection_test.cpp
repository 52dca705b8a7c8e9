// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/detection.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// What a sensor sees of a disc.
std::vector<Point2> near_side(const Point2& sensor, const Point2& centre, double radius,
                              double noise) {
  RandomStream random(7, "near_side");
  std::vector<Point2> points;
  const Point2 ahead = (centre - sensor).normalized();
  const Point2 left(-ahead.y(), ahead.x());
  const double distance = (centre - sensor).norm();
  for (int i = -30; i <= 30; ++i) {
    const double aside = radius * i / 30.5;
    const double depth = distance - std::sqrt(radius * radius - aside * aside);
    points.push_back(sensor + (depth + noise * random.normal()) * ahead + aside * left);
  }
  return points;
}

TEST(DetectBody, PutsTheCentreBehindTheSideThatIsSeen) {
  const Point2 sensor(2.0, -1.0);
  for (const double radius : {0.2, 0.3, 0.5}) {
    for (const double azimuth : {0.0, 1.0, 3.1, -2.0}) {
      const Point2 centre = sensor + 10.0 * Point2(std::cos(azimuth), std::sin(azimuth));
      const auto body = detect_body(near_side(sensor, centre, radius, 0.02), sensor, {});
      ASSERT_TRUE(body);
      EXPECT_LT((body->position - centre).norm(), 0.05);
      EXPECT_NEAR(body->across_m, 2.0 * radius, 0.03);
      EXPECT_EQ(body->points_count, 61);
    }
  }
}

TEST(DetectBody, AKnownWidthPutsAPartAsDeepAsTheWhole) {
  const std::vector<Point2> part = {{9.5, -0.05}, {9.5, 0.05}};
  EXPECT_NEAR(detect_body(part, {0.0, 0.0}, {}, 0.6)->position.x(), 9.8, 0.01);
  EXPECT_NEAR(detect_body(part, {0.0, 0.0}, {})->position.x(), 9.55, 0.01);
}

TEST(DetectBody, WideAnimalsAreNotAsDeepAsWide) {
  std::vector<Point2> flank;
  for (int i = -10; i <= 10; ++i) flank.emplace_back(8.0, 0.11 * i);
  BodyConfig config;
  config.deepest_m = 0.8;
  EXPECT_NEAR(detect_body(flank, {0.0, 0.0}, config)->position.x(), 8.4, 0.01);
}

TEST(DetectBody, NoiseGrowsWithRange) {
  const auto near_one = detect_body(std::vector<Point2>{{5.0, 0.0}}, {0.0, 0.0}, {});
  const auto far_one = detect_body(std::vector<Point2>{{40.0, 0.0}}, {0.0, 0.0}, {});
  EXPECT_GT(far_one->covariance(0, 0), near_one->covariance(0, 0));
  EXPECT_TRUE(is_sound(*near_one));
}

TEST(DetectBody, PointsThatAreNoNumbersDoNotCount) {
  std::vector<Point2> points = near_side({0.0, 0.0}, {10.0, 0.0}, 0.3, 0.0);
  const auto clean = detect_body(points, {0.0, 0.0}, {});
  points.emplace_back(kNan, 1.0);
  points.emplace_back(1.0, std::numeric_limits<double>::infinity());
  const auto body = detect_body(points, {0.0, 0.0}, {});
  ASSERT_TRUE(body);
  EXPECT_EQ(body->position, clean->position);
  EXPECT_EQ(body->points_count, clean->points_count);
}

TEST(DetectBody, NothingIsNobody) {
  EXPECT_FALSE(detect_body({}, {0.0, 0.0}, {}));
  EXPECT_FALSE(detect_body(std::vector<Point2>{{kNan, kNan}}, {0.0, 0.0}, {}));
  EXPECT_FALSE(detect_body(std::vector<Point2>{{1.0, 1.0}}, {kNan, 0.0}, {}));
}

TEST(DetectBody, APointOnTheSensorStaysANumber) {
  const auto body = detect_body(std::vector<Point2>{{1.0, 1.0}}, {1.0, 1.0}, {});
  ASSERT_TRUE(body);
  EXPECT_TRUE(is_sound(*body));
}

TEST(IsSound, RefusesWhatIsNoNumberAndNoCovariance) {
  Detection detection;
  EXPECT_TRUE(is_sound(detection));
  detection.position.x() = kNan;
  EXPECT_FALSE(is_sound(detection));
  detection = {};
  detection.covariance.setZero();
  EXPECT_FALSE(is_sound(detection));
  detection = {};
  detection.probability = {kNan, 0.0, 0.0, 0.0};
  EXPECT_FALSE(is_sound(detection));
  detection = {};
  detection.position.x() = 1e9;
  EXPECT_FALSE(is_sound(detection));
}

}  // namespace
}  // namespace headland
