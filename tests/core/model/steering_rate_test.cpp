// SPDX-License-Identifier: Apache-2.0
#include "core/model/steering_rate.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/fishtail.hpp"
#include "core/geometry/smooth_dubins.hpp"

namespace headland {
namespace {

Vehicle steered() {
  Vehicle v;
  v.wheelbase_m = 2.0;
  v.steering_rate_radps = 0.6;
  v.min_turning_radius_m = 3.2;
  return v;
}

TEST(SteeringRate, SharpnessIsWhatTheSteeringFollowsFromStraightWheels) {
  EXPECT_NEAR(sharpness_limit(steered(), 1.5), 0.95 * 0.6 / (2.0 * 1.5), 1e-15);
  Vehicle rover;
  rover.steering = Steering::kDifferential;
  EXPECT_TRUE(std::isinf(sharpness_limit(rover, 1.0)));
  rover.yaw_acceleration_radps2 = 2.0;
  EXPECT_NEAR(sharpness_limit(rover, 2.0), 0.95 * 2.0 / 4.0, 1e-15);
}

TEST(SteeringRate, AStepSlowsDownUntilTheErrorIsSmallEnough) {
  const double step = 1.0 / 3.2;
  const auto slow = slow_at_step(steered(), 0.0, step, 3.0);
  ASSERT_TRUE(slow);
  const double seconds = std::atan(2.0 * step) / (0.95 * 0.6);
  EXPECT_NEAR(slow->length, slow->speed * seconds, 1e-12);
  EXPECT_NEAR(step * slow->length * slow->length / 24.0, 0.02, 1e-12);
  EXPECT_FALSE(slow_at_step(steered(), 0.0, step, 0.5));
  EXPECT_FALSE(slow_at_step(steered(), step, step, 3.0));
}

TEST(SteeringRate, ACurveOfTheSharpnessOfASpeedIsDrivenAtThatSpeed) {
  const Vehicle v = steered();
  for (const double part : {1.0, 0.6, 0.35}) {
    const SmoothTurn turn({1.0 / 3.2, (1.0 - 1e-12) * sharpness_limit(v, part * 1.5)});
    const Curve curve = smooth_dubins({}, {0.0, 12.0, kPi}, turn);
    const double lost = slow_down_time(v, curve, 1.5);
    if (part == 1.0) {
      EXPECT_NEAR(lost, 0.0, 1e-12);
      continue;
    }
    // Four clothoids at the lower speed, and the braking for them.
    const double slow = 4.0 * turn.ramp() * 3.2 * (1.0 / part - 1.0) / 1.5;
    EXPECT_GT(lost, slow);
    EXPECT_LT(lost, slow + 8.0);
  }
}

TEST(SteeringRate, WheelsTurnAtCuspsWithoutLossOfTime) {
  Vehicle v = steered();
  const SmoothTurn turn({1.0 / 3.2, (1.0 - 1e-12) * sharpness_limit(v, 1.0)});
  const auto curve = fishtail({}, {0.0, 2.5, kPi}, turn);
  ASSERT_TRUE(curve);
  EXPECT_NEAR(slow_down_time(v, *curve, 1.0), 0.0, 1e-12);
  EXPECT_GT(slow_down_time(v, *curve, 2.0), 1.0);
  v.steering = Steering::kDifferential;
  EXPECT_EQ(slow_down_time(v, *curve, 2.0), 0.0);
}

}  // namespace
}  // namespace headland
