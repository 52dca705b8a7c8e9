// SPDX-License-Identifier: Apache-2.0
#include "local_planner/fail_safe/fail_safe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/local_planner/fail_safe/encounters.hpp"
#include "tests/local_planner/planner_laws.hpp"
#include "tests/local_planner/vehicles.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland::test {
namespace {

Vehicle plain_robot() {
  Vehicle vehicle = field_robot();
  vehicle.speed_lag_s = 0.0;
  vehicle.steering_lag_s = 0.0;
  return vehicle;
}

VehicleState moving(double speed) {
  VehicleState state;
  state.speed = speed;
  return state;
}

SafeCommand limited(const Vehicle& vehicle, const VehicleState& robot,
                    const std::vector<Agent>& agents, const Command& wanted,
                    const FailSafeConfig& config = {}) {
  FailSafe fail_safe(vehicle, config);
  return fail_safe.limit({0.0, robot, agents, nullptr, 0.0}, wanted);
}

TEST(FailSafe, StraightAheadTheAllowedSpeedIsTheStandards) {
  const Vehicle vehicle = plain_robot();
  const FailSafeConfig config;
  for (const double distance : {1.5, 2.0, 3.0, 4.0, 5.0}) {
    const double ahead = vehicle.footprint.front_m + distance + 0.3;
    const SafeCommand safe = limited(vehicle, moving(1.5), {agent_at(ahead, 0.0)}, {1.5, 0.0, 0.0});
    const Stopping stopping(config.reaction_time_s, vehicle.acceleration_mps2, 0.0,
                            safe.allowed_speed);
    const double needed =
        protective_distance(stopping, config.agent_speed_mps, config.allowances());
    if (safe.reason == SafetyReason::kNone) {
      EXPECT_EQ(safe.allowed_speed, 1.5);
      EXPECT_LE(needed, distance);
    } else {
      EXPECT_NEAR(needed, distance, 0.06) << distance;
      EXPECT_EQ(safe.reason, SafetyReason::kAgent);
      EXPECT_EQ(safe.nearest, 0);
    }
    EXPECT_NEAR(safe.gap, distance, 1e-9);
  }
}

TEST(FailSafe, WhoeverIsLeftBehindOrBesideDoesNotStopTheRobot) {
  const Vehicle vehicle = plain_robot();
  for (const double gear : {1.0, -1.0}) {
    const double rear = gear > 0.0 ? -vehicle.footprint.rear_m : vehicle.footprint.front_m;
    const Command wanted{gear * 0.6, 0.0, 0.0};
    for (const Agent& agent : {agent_at(rear - gear * 0.4, 0.2), agent_at(rear - gear * 0.1, 1.2),
                               agent_at(rear + gear * 0.2, -1.4)}) {
      const SafeCommand safe = limited(vehicle, moving(gear * 0.6), {agent}, wanted);
      EXPECT_EQ(safe.reason, SafetyReason::kNone) << gear << ", " << agent.position.transpose();
      EXPECT_EQ(safe.command.speed, wanted.speed);
    }
    const double front = gear > 0.0 ? vehicle.footprint.front_m : -vehicle.footprint.rear_m;
    const SafeCommand blocked =
        limited(vehicle, moving(gear * 0.6), {agent_at(front + gear * 0.6, 0.0)}, wanted);
    EXPECT_EQ(blocked.allowed_speed, 0.0);
    EXPECT_EQ(blocked.command.speed, 0.0);
  }
}

TEST(FailSafe, TheInsideOfATurnIsGuarded) {
  const Vehicle vehicle = plain_robot();
  FailSafeConfig config;
  config.agent_speed_mps = 0.3;
  const auto allowed = [&](double steering) {
    VehicleState robot = moving(0.5);
    robot.steering = steering;
    const Command wanted{0.5, steering, 0.0};
    return limited(vehicle, robot, {agent_at(1.2, 1.5)}, wanted, config).allowed_speed;
  };
  EXPECT_EQ(allowed(0.0), 0.5);
  EXPECT_EQ(allowed(-0.6), 0.5);
  EXPECT_LT(allowed(0.6), 0.1);
}

TEST(FailSafe, ATurnThatIsOnlySafeMoreSlowlyWaits) {
  const Vehicle vehicle = plain_robot();
  FailSafe fail_safe(vehicle);
  const std::vector<Agent> agents = {agent_at(2.0, 3.2)};
  LocalScene scene{0.0, moving(0.9), agents, nullptr, 0.0};
  EXPECT_EQ(fail_safe.limit(scene, {0.9, -0.3, 0.0}).reason, SafetyReason::kNone);
  scene.time_s = 0.05;
  const SafeCommand safe = fail_safe.limit(scene, {0.9, 0.5, 0.0});
  EXPECT_EQ(safe.reason, SafetyReason::kAgent);
  EXPECT_EQ(safe.command.steering, -0.3);
  EXPECT_LT(safe.command.speed, 0.9);
  scene.robot.state.speed = 0.1;
  EXPECT_EQ(fail_safe.limit(scene, {0.1, 0.5, 0.0}).command.steering, 0.5);
}

TEST(FailSafe, ObservedAgentsThatLeaveLetTheRobotDrive) {
  const Vehicle vehicle = plain_robot();
  FailSafeConfig observed;
  observed.agents = AgentMotion::kObserved;
  const auto allowed = [&](const Agent& agent, const FailSafeConfig& config) {
    return limited(vehicle, moving(1.2), {agent}, {1.2, 0.0, 0.0}, config).allowed_speed;
  };
  const Agent leaves = agent_at(4.5, 0.0, 1.4, 0.0);
  const Agent stands = agent_at(4.5, 0.0);
  const Agent comes = agent_at(4.5, 0.0, -1.4, 0.0);
  EXPECT_EQ(allowed(leaves, observed), 1.2);
  EXPECT_GT(allowed(stands, observed), 1.2 * allowed(comes, observed));
  EXPECT_GT(allowed(stands, observed), allowed(stands, {}));
  EXPECT_EQ(allowed(leaves, {}), allowed(comes, {})) << "the worst case knows no direction";
  Agent unsure = stands;
  unsure.noise_m = 0.3;
  EXPECT_LT(allowed(unsure, {}), allowed(stands, {}));
  const Agent runs = agent_at(4.5, 0.0, -2.8, 0.0);
  EXPECT_LT(allowed(runs, {}), allowed(comes, {})) << "faster than the worst case is believed";
}

TEST(FailSafe, NobodyIsPassedFastAtArmsLength) {
  const Vehicle vehicle = plain_robot();
  FailSafeConfig config;
  config.agents = AgentMotion::kObserved;
  config.intrusion_m = config.agent_error_m = config.robot_error_m = 0.0;
  config.agent_acceleration_mps2 = 0.0;
  const Agent beside = agent_at(0.5, 0.75 + 0.3 + 0.2);
  const SafeCommand safe = limited(vehicle, moving(1.0), {beside}, {1.0, 0.0, 0.0}, config);
  EXPECT_EQ(safe.reason, SafetyReason::kNear);
  EXPECT_EQ(safe.allowed_speed, config.near_speed_mps);
  const Agent behind = agent_at(-0.5 - 0.3 - 0.2, 0.0);
  EXPECT_EQ(limited(vehicle, moving(1.0), {behind}, {1.0, 0.0, 0.0}, config).reason,
            SafetyReason::kNone);
}

TEST(FailSafe, OldScenesAndNoNumbersStopIt) {
  const Vehicle vehicle = field_robot();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Command wanted{1.0, 0.1, 0.0};
  const auto reason = [&](const LocalScene& scene, const Command& command) {
    FailSafe fail_safe(vehicle);
    const SafeCommand safe = fail_safe.limit(scene, command);
    EXPECT_LT(std::abs(safe.command.speed), 0.5);
    EXPECT_TRUE(std::isfinite(safe.command.steering));
    return safe.reason;
  };
  const std::vector<Agent> lost = {agent_at(30.0, nan)};
  EXPECT_EQ(reason({0.0, moving(0.6), {}, nullptr, 0.6}, wanted), SafetyReason::kStale);
  EXPECT_EQ(reason({0.0, moving(0.6), {}, nullptr, nan}, wanted), SafetyReason::kBadInput);
  EXPECT_EQ(reason({0.0, moving(nan), {}, nullptr, 0.0}, wanted), SafetyReason::kBadInput);
  EXPECT_EQ(reason({0.0, moving(0.6), lost, nullptr, 0.0}, wanted), SafetyReason::kBadInput);
  EXPECT_EQ(reason({0.0, moving(0.6), {}, nullptr, 0.0}, {nan, 0.0, 0.0}), SafetyReason::kBadInput);
}

TEST(FailSafe, WallsAreStoppedForAndLeft) {
  const ClearanceMap map = ClearanceMap::of({box(6.0, -5.0, 7.0, 5.0)});
  for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
    FailSafe fail_safe(vehicle);
    VehicleState robot;
    for (int i = 0; i < 400; ++i) {
      const LocalScene scene{0.05 * i, robot, {}, &map, 0.0};
      robot = step_vehicle(vehicle, robot, fail_safe.limit(scene, {1.4, 0.0, 0.0}).command, 0.05);
    }
    EXPECT_EQ(std::abs(robot.speed) < 0.01, true) << vehicle.name;
    EXPECT_LT(robot.pose.x + vehicle.footprint.front_m, 6.0) << vehicle.name;
    EXPECT_GT(robot.pose.x + vehicle.footprint.front_m, 5.0) << vehicle.name;
    const LocalScene scene{20.0, robot, {}, &map, 0.0};
    EXPECT_EQ(fail_safe.limit(scene, {-0.5, 0.0, 0.0}).command.speed, -0.5) << vehicle.name;
  }
}

TEST(FailSafe, ARoverDoesNotTurnIntoSomebody) {
  const Vehicle vehicle = rover();
  const Command left{0.0, 0.0, 0.5};
  EXPECT_EQ(limited(vehicle, {}, {agent_at(4.0, 0.0)}, left).command.yaw_rate, 0.5);
  const SafeCommand safe = limited(vehicle, {}, {agent_at(0.8, 1.1)}, left);
  EXPECT_EQ(safe.reason, SafetyReason::kAgent);
  EXPECT_EQ(safe.command.yaw_rate, 0.0);
  // Rolling, it stops before it turns on the spot.
  const SafeCommand rolling = limited(vehicle, moving(1.0), {}, left);
  EXPECT_NEAR(rolling.command.yaw_rate, 0.0, 1e-12);
  EXPECT_LT(rolling.command.speed, 1.0);
}

TEST(FailSafe, ARoverWithALongTailSweepsNobodyWithIt) {
  Vehicle with_nose = rover();
  with_nose.footprint = {2.5, 0.5, 1.0};
  Vehicle with_tail = rover();
  with_tail.footprint = {0.5, 2.5, 1.0};
  const Command left{0.0, 0.0, 0.5};
  RandomStream random(6, "tails");
  int stopped = 0;
  for (int i = 0; i < 500; ++i) {
    const Point2 p(random.uniform(-5.0, 5.0), random.uniform(-4.0, 4.0));
    const SafeCommand nose = limited(with_nose, {}, {agent_at(p.x(), p.y())}, left);
    const SafeCommand tail = limited(with_tail, {}, {agent_at(-p.x(), -p.y())}, left);
    EXPECT_NEAR(nose.allowed_speed, tail.allowed_speed, 1e-9) << p.transpose();
    EXPECT_EQ(nose.reason, tail.reason) << p.transpose();
    stopped += tail.allowed_speed == 0.0 ? 1 : 0;
  }
  EXPECT_GT(stopped, 50);
}

TEST(FailSafe, AStandHasNoCurve) {
  const Vehicle vehicle = rover();
  const std::vector<Agent> agents = {agent_at(1.6, 0.0)};
  for (const double speed : {0.02, 1e-9, 1e-320}) {
    VehicleState turning = moving(speed);
    turning.yaw_rate = 0.5;
    const SafeCommand safe = limited(vehicle, turning, agents, {1.0, 0.0, 0.0});
    EXPECT_EQ(safe.reason, SafetyReason::kAgent);
    EXPECT_EQ(safe.command.yaw_rate, 0.0) << speed;
  }
}

TEST(FailSafe, NeverSpeedsUpAndKeepsTheCurve) {
  RandomStream random(3, "commands");
  for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
    FailSafe fail_safe(vehicle);
    for (int i = 0; i < 2000; ++i) {
      VehicleState robot = moving(random.uniform(-2.0, 2.0));
      robot.steering = random.uniform(-0.6, 0.6);
      robot.yaw_rate = random.uniform(-0.6, 0.6);
      const Command wanted{random.uniform(-2.0, 2.0), random.uniform(-0.6, 0.6),
                           random.uniform(-0.6, 0.6)};
      const std::vector<Agent> agents = crowd(random.index(4), 8.0, random);
      const SafeCommand safe = fail_safe.limit({10.0 * i, robot, agents, nullptr, 0.0}, wanted);
      EXPECT_LE(std::abs(safe.command.speed), std::abs(wanted.speed) + 1e-12);
      EXPECT_GE(safe.command.speed * wanted.speed, 0.0);
      EXPECT_LE(safe.allowed_speed, std::max({std::abs(robot.speed), std::abs(wanted.speed),
                                              std::abs(wanted.yaw_rate)}) +
                                        1e-12);
      if (safe.reason == SafetyReason::kNone && robot.speed * wanted.speed > 0.05) {
        EXPECT_EQ(safe.command.speed, wanted.speed);
      }
    }
  }
}

TEST(FailSafe, ATickDoesNotAllocate) {
  RandomStream random(4, "crowd");
  FailSafe fail_safe(field_robot());
  const std::vector<Agent> agents = crowd(50, 8.0, random);
  const LocalScene scene{0.0, moving(1.0), agents, nullptr, 0.0};
  fail_safe.limit(scene, {1.0, 0.0, 0.0});
  const long before = headland::testing::allocation_count();
  fail_safe.limit(scene, {1.0, 0.1, 0.0});
  EXPECT_EQ(headland::testing::allocation_count(), before);
}

TEST(FailSafe, TouchesNobodyInAHundredEncounters) {
  for (int i = 0; i < 96; ++i) {
    RandomStream random(static_cast<std::uint64_t>(i), "few encounters");
    const Vehicle vehicle = i % 3 == 0 ? field_robot() : i % 3 == 1 ? tractor() : rover();
    const Encounter e = encounter(vehicle, {}, static_cast<Behavior>(i % kBehaviors),
                                  random.uniform(0.5, vehicle.transit_speed_mps), 0.0, random);
    EXPECT_LE(e.worst_closing, 0.05) << i;
  }
}

}  // namespace
}  // namespace headland::test
