// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/angle.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

TEST(Angle, WrapsToTheHalfOpenIntervalThatHoldsPlusPi) {
  EXPECT_EQ(wrap_angle(0.0), 0.0);
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(3.0 * kPi), kPi, 1e-15);
  EXPECT_NEAR(wrap_angle(1.5 * kPi), -0.5 * kPi, 1e-15);
  EXPECT_NEAR(wrap_angle(-1.5 * kPi), 0.5 * kPi, 1e-15);
}

TEST(Angle, WrappingKeepsTheDirectionAndIsIdempotent) {
  RandomStream random(1, "angle");
  for (int i = 0; i < 10000; ++i) {
    const double angle = random.uniform(-100.0, 100.0);
    const double wrapped = wrap_angle(angle);
    ASSERT_GT(wrapped, -kPi);
    ASSERT_LE(wrapped, kPi);
    ASSERT_NEAR(std::cos(wrapped), std::cos(angle), 1e-13);
    ASSERT_NEAR(std::sin(wrapped), std::sin(angle), 1e-13);
    ASSERT_EQ(wrap_angle(wrapped), wrapped);
  }
}

TEST(Angle, WrapsToPositiveTurns) {
  EXPECT_EQ(wrap_positive(0.0), 0.0);
  EXPECT_NEAR(wrap_positive(-0.5 * kPi), 1.5 * kPi, 1e-15);
  EXPECT_NEAR(wrap_positive(5.0 * kPi), kPi, 1e-14);
  RandomStream random(2, "angle");
  for (int i = 0; i < 10000; ++i) {
    const double wrapped = wrap_positive(random.uniform(-100.0, 100.0));
    ASSERT_GE(wrapped, 0.0);
    ASSERT_LT(wrapped, 2.0 * kPi);
  }
}

TEST(Angle, ATurnOfAlmostNothingIsNeverAFullCircle) {
  EXPECT_LT(wrap_positive(-std::numeric_limits<double>::min()), 2.0 * kPi);
  EXPECT_EQ(wrap_positive(-1e-17), 0.0);
  EXPECT_EQ(wrap_positive(-1e-12, 1e-9), 0.0);
  EXPECT_GT(wrap_positive(-1e-6, 1e-9), 6.28);
}

TEST(Angle, ConvertsDegrees) {
  EXPECT_DOUBLE_EQ(deg_to_rad(180.0), kPi);
  EXPECT_DOUBLE_EQ(rad_to_deg(deg_to_rad(-37.5)), -37.5);
}

}  // namespace
}  // namespace headland
