// SPDX-License-Identifier: Apache-2.0
#include "core/model/command_delay.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

TEST(CommandDelay, SpeedAndSteeringActAfterTheirOwnDeadTimes) {
  Vehicle vehicle;
  vehicle.speed_dead_time_s = 0.1;
  vehicle.steering_dead_time_s = 0.3;
  CommandDelay delay(vehicle, 0.1);
  for (int i = 1; i <= 10; ++i) {
    const Command acting = delay.push({1.0 * i, 2.0 * i, 3.0 * i});
    EXPECT_EQ(acting.speed, std::max(0, i - 1));
    EXPECT_EQ(acting.steering, 2.0 * std::max(0, i - 3));
    EXPECT_EQ(acting.yaw_rate, 3.0 * std::max(0, i - 3));
  }
  EXPECT_EQ(delay.acting(1).steering, 16.0);
  EXPECT_EQ(delay.acting(1).speed, 10.0);
  EXPECT_EQ(delay.acting(3).steering, 20.0);
  EXPECT_EQ(delay.acting(50).steering, 20.0);
  EXPECT_EQ(delay.longest(), 3);
  delay.reset({0.0, 0.5, 0.0});
  EXPECT_EQ(delay.push({1.0, 1.0, 0.0}).steering, 0.5);
}

TEST(CommandDelay, WithoutDeadTimesCommandsActAtOnce) {
  CommandDelay delay(Vehicle(), 0.02);
  EXPECT_EQ(delay.push({1.5, 0.2, 0.1}).speed, 1.5);
  EXPECT_EQ(delay.acting(0).steering, 0.2);
  EXPECT_EQ(delay.longest(), 0);
}

}  // namespace
}  // namespace headland
