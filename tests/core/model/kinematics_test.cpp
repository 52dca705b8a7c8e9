// SPDX-License-Identifier: Apache-2.0
#include "core/model/kinematics.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

Vehicle tractor() {
  Vehicle vehicle;
  vehicle.wheelbase_m = 2.0;
  vehicle.max_steering_deg = 35.0;
  vehicle.steering_rate_radps = 0.5;
  vehicle.acceleration_mps2 = 1.0;
  return vehicle;
}

VehicleState drive(const Vehicle& vehicle, VehicleState state, const Command& command,
                   double seconds, double dt = 0.01) {
  for (int i = 0; i < static_cast<int>(std::lround(seconds / dt)); ++i) {
    state = step_vehicle(vehicle, state, command, dt);
  }
  return state;
}

TEST(Ackermann, ClosesACircleOfTheSteeringsRadius) {
  const Vehicle vehicle = tractor();
  VehicleState state;
  state.speed = 1.0;
  state.steering = 0.4;
  const double radius = vehicle.wheelbase_m / std::tan(0.4);
  const VehicleState half =
      drive(vehicle, state, {1.0, 0.4, 0.0}, kPi * radius, kPi * radius / 1000.0);
  EXPECT_NEAR(half.pose.x, 0.0, 1e-9);
  EXPECT_NEAR(half.pose.y, 2.0 * radius, 1e-9);
}

TEST(Ackermann, SteeringKeepsItsRateAndLimit) {
  const Vehicle vehicle = tractor();
  VehicleState state = drive(vehicle, {}, {0.0, 10.0, 0.0}, 0.5);
  EXPECT_NEAR(state.steering, 0.25, 1e-9);
  state = drive(vehicle, state, {0.0, 10.0, 0.0}, 5.0);
  EXPECT_NEAR(state.steering, vehicle.max_steering_rad(), 1e-12);
}

TEST(Ackermann, SteeringLagIsFirstOrder) {
  Vehicle vehicle = tractor();
  vehicle.steering_rate_radps = 100.0;
  vehicle.steering_lag_s = 0.2;
  const VehicleState state = drive(vehicle, {}, {0.0, 0.3, 0.0}, 0.2);
  EXPECT_NEAR(state.steering, 0.3 * (1.0 - std::exp(-1.0)), 1e-9);
}

TEST(Ackermann, ReverseWithLeftSteeringTurnsTheHeadingRight) {
  VehicleState state;
  state.steering = 0.3;
  state.speed = -1.0;
  const VehicleState after = drive(tractor(), state, {-1.0, 0.3, 0.0}, 1.0);
  EXPECT_LT(after.pose.x, 0.0);
  EXPECT_LT(after.pose.yaw, 0.0);
}

TEST(Vehicle, SpeedKeepsItsAcceleration) {
  const VehicleState state = drive(tractor(), {}, {2.0, 0.0, 0.0}, 1.0);
  EXPECT_NEAR(state.speed, 1.0, 1e-12);
  EXPECT_NEAR(state.pose.x, 0.5, 1e-12);
}

TEST(Differential, PivotsOnTheSpot) {
  Vehicle rover;
  rover.steering = Steering::kDifferential;
  const VehicleState state = drive(rover, {}, {0.0, 0.0, 0.5}, 1.0);
  EXPECT_NEAR(state.pose.x, 0.0, 1e-12);
  EXPECT_NEAR(state.pose.yaw, 0.5, 1e-9);
}

TEST(Differential, WheelSpeedsCarryTheHalfTrack) {
  const WheelSpeeds straight = wheel_speeds(1.0, 0.0, 1.0, 0.2);
  EXPECT_DOUBLE_EQ(straight.left, 5.0);
  EXPECT_DOUBLE_EQ(straight.right, 5.0);
  const WheelSpeeds pivot = wheel_speeds(0.0, 1.0, 1.0, 0.2);
  EXPECT_DOUBLE_EQ(pivot.left, -2.5);
  EXPECT_DOUBLE_EQ(pivot.right, 2.5);
}

TEST(Vehicle, PlanningRadiusIsTheLargerOfSteeringAndSetting) {
  Vehicle vehicle = tractor();
  EXPECT_NEAR(vehicle.turning_radius(), 2.0 / std::tan(deg_to_rad(35.0)), 1e-12);
  vehicle.min_turning_radius_m = 5.0;
  EXPECT_EQ(vehicle.turning_radius(), 5.0);
}

}  // namespace
}  // namespace headland
