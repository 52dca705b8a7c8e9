// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/prediction/wandering_robot.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace headland {
namespace {

constexpr double kDt = 0.1;

std::vector<Agent> a_person() {
  Agent person;
  person.position = {2.0, -1.0};
  return {person};
}

TEST(WanderingRobot, DrivesAsARobotCan) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    WanderingRobot robot(10.0, 1.5, seed);
    Point2 before = robot.velocity();
    for (int i = 0; i < 600; ++i) {
      const Point2 from = robot.position();
      robot.step(kDt, a_person());
      const Point2 now = robot.velocity();
      ASSERT_NEAR((robot.position() - from - kDt * now).norm(), 0.0, 1e-9);
      ASSERT_LE(now.norm(), 2.0 + 1e-9);
      // Speed by at most 1.5 m/s2; heading by at most 1 rad a metre.
      ASSERT_LE(std::abs(now.norm() - before.norm()), 1.5 * kDt + 1e-9);
      ASSERT_LE((now - before).norm(), 1.5 * kDt + now.norm() * kDt * 2.0 + 1e-9);
      before = now;
    }
    EXPECT_LT(robot.position().norm(), 40.0) << "it comes back";
  }
}

TEST(WanderingRobot, DrivesStandsAndMeetsPeople) {
  int standing = 0;
  int moving = 0;
  int meeting = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    WanderingRobot robot(6.0, 0.5, seed);
    for (int i = 0; i < 600; ++i) {
      robot.step(kDt, a_person());
      standing += robot.velocity().norm() < 1e-6 ? 1 : 0;
      moving += robot.velocity().norm() > 0.3 ? 1 : 0;
      meeting += (robot.position() - a_person().front().position).norm() < 2.0 ? 1 : 0;
    }
  }
  EXPECT_GT(standing, 200);
  EXPECT_GT(moving, 4000);
  EXPECT_GT(meeting, 600);
}

TEST(WanderingRobot, TheSameSeedDrivesTheSameWay) {
  WanderingRobot a(6.0, 0.5, 3), b(6.0, 0.5, 3), c(6.0, 0.5, 4);
  for (int i = 0; i < 300; ++i) {
    for (WanderingRobot* robot : {&a, &b, &c}) robot->step(kDt, a_person());
  }
  EXPECT_EQ(a.position(), b.position());
  EXPECT_NE(a.position(), c.position());
}

TEST(WanderingRobot, DrivesWithNobodyThere) {
  WanderingRobot robot(6.0, 0.5, 5);
  for (int i = 0; i < 600; ++i) robot.step(kDt, {});
  EXPECT_TRUE(robot.position().allFinite());
}

}  // namespace
}  // namespace headland
