// SPDX-License-Identifier: Apache-2.0
#include "control/speed_ramp.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

constexpr double kCycle = 0.02;        // [s]
constexpr double kAcceleration = 0.8;  // [m/s^2]

// From 2.5 m/s to a stand with speeds read to `noise` [m/s]: how long it takes [s].
double braking_time(double noise) {
  SpeedRamp ramp(kAcceleration);
  RandomStream random(1, "tests/speed_ramp");
  double speed = 2.5;
  double time = 0.0;
  for (; speed > 0.0 && time < 60.0; time += kCycle) {
    const auto [low, high] = ramp.reach(speed + noise * random.normal(), kCycle);
    const double told = std::clamp(0.0, low, high);
    ramp.tell(told);
    const double most = kAcceleration * kCycle;
    speed += std::clamp(told - speed, -most, most);
  }
  return time;
}

TEST(SpeedRamp, BrakesAtTheAccelerationHoweverNoisyTheSpeedIs) {
  const double least = 2.5 / kAcceleration;
  EXPECT_NEAR(braking_time(0.0), least, 2.0 * kCycle);
  EXPECT_NEAR(braking_time(0.05), least, 0.05 * least);
}

TEST(SpeedRamp, StaysNearAVehicleThatDoesNotFollow) {
  SpeedRamp ramp(kAcceleration);
  for (int i = 0; i < 1000; ++i) ramp.tell(ramp.reach(0.3, kCycle).high);
  const double most = 0.3 + (0.5 + kCycle) * kAcceleration;
  EXPECT_NEAR(ramp.reach(0.3, kCycle).high, most, 1e-12);
}

TEST(SpeedRamp, BeginsAtTheMeasuredSpeed) {
  SpeedRamp ramp(kAcceleration);
  EXPECT_DOUBLE_EQ(ramp.reach(1.0, kCycle).high, 1.0 + kAcceleration * kCycle);
  ramp.tell(1.1);
  ramp.reset();
  EXPECT_DOUBLE_EQ(ramp.reach(1.0, kCycle).low, 1.0 - kAcceleration * kCycle);
}

}  // namespace
}  // namespace headland
