// SPDX-License-Identifier: Apache-2.0
#include "control/position_filter.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

PositionFilterConfig perfect_odometry(double accuracy) {
  PositionFilterConfig config;
  config.fix_accuracy_m = accuracy;
  config.odometry_drift_m = 0.0;
  config.scale_error_ratio = 0.0;
  config.heading_error_deg = 0.0;
  return config;
}

Point2 noisy(const Point2& p, double accuracy, RandomStream& random) {
  const double dx = random.uniform(-accuracy, accuracy);
  return p + Point2(dx, random.uniform(-accuracy, accuracy));
}

TEST(PositionFilter, TakesExactFixesAsTheyAre) {
  PositionFilter filter(perfect_odometry(0.0));
  filter.update({0.0, 0.0}, {1.0, 2.0});
  filter.update({5.0, 0.0}, {1.5, 2.5});
  EXPECT_EQ(filter.position(), Point2(1.5, 2.5));
}

TEST(PositionFilter, IsTheRunningMeanOfTheFixesWhenTheOdometryIsPerfect) {
  PositionFilter filter(perfect_odometry(0.1));
  RandomStream random(7, "test");
  const Point2 step(0.1, 0.02);
  Point2 sum(0.0, 0.0);  // of the fixes' errors
  Point2 truth(3.0, 4.0);
  for (int i = 0; i < 500; ++i) {
    if (i > 0) truth += step;
    const Point2 fix = noisy(truth, 0.1, random);
    sum += fix - truth;
    filter.update(step, fix);
    ASSERT_LT((filter.position() - truth - sum / (i + 1)).norm(), 1e-9);
  }
  EXPECT_NEAR(filter.position_variance(), 0.1 * 0.1 / 3.0 / 500.0, 1e-9);
}

TEST(PositionFilter, LearnsTheScaleAndTheDirectionOfTheOdometry) {
  PositionFilterConfig config;
  config.fix_accuracy_m = 0.02;
  PositionFilter filter(config);
  RandomStream random(1, "test");
  const double scale = 1.02;
  const double slant = deg_to_rad(-0.8);
  Pose2 truth{0.0, 0.0, 0.4};
  filter.update({0.0, 0.0}, truth.position());
  for (int i = 0; i < 2000; ++i) {
    truth.yaw += 0.001;
    const Point2 told = 0.1 * truth.heading();
    const Pose2 travel{0.0, 0.0, truth.yaw + slant};
    truth.x += 0.1 * scale * travel.heading().x();
    truth.y += 0.1 * scale * travel.heading().y();
    filter.update(told, noisy(truth.position(), 0.02, random));
  }
  EXPECT_NEAR(filter.scale_error(), scale - 1.0, 0.001);
  EXPECT_NEAR(filter.heading_error(), slant, 0.001);
  EXPECT_LT((filter.position() - truth.position()).norm(), 0.006);
}

TEST(PositionFilter, KnowsHowGoodItIs) {
  // Odometry with the errors the filter expects: the true error agrees with the told variance.
  PositionFilterConfig config;
  config.fix_accuracy_m = 0.05;
  double squares = 0.0;
  double told = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    PositionFilter filter(config);
    RandomStream random(static_cast<std::uint64_t>(run), "test");
    const double scale = config.scale_error_ratio * random.normal();
    const double slant = deg_to_rad(config.heading_error_deg) * random.normal();
    Point2 truth(0.0, 0.0);
    filter.update({0.0, 0.0}, noisy(truth, 0.05, random));
    for (int i = 0; i < 400; ++i) {
      const double drift = config.odometry_drift_m * std::sqrt(0.1);
      truth.x() += 0.1 * (1.0 + scale) + drift * random.normal();
      truth.y() += 0.1 * slant + drift * random.normal();
      filter.update({0.1, 0.0}, noisy(truth, 0.05, random));
    }
    squares += (filter.position() - truth).squaredNorm() / kRuns;
    told += 2.0 * filter.position_variance() / kRuns;
  }
  EXPECT_NEAR(squares / told, 1.0, 0.25);
}

TEST(PositionFilter, StartsAnewAfterAReset) {
  PositionFilter filter(perfect_odometry(0.1));
  filter.update({0.0, 0.0}, {1.0, 1.0});
  filter.reset();
  filter.update({1.0, 0.0}, {9.0, 9.0});
  EXPECT_EQ(filter.position(), Point2(9.0, 9.0));
}

}  // namespace
}  // namespace headland
