// SPDX-License-Identifier: Apache-2.0
#include "local_planner/mcts/internal/manoeuvres.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/local_planner/vehicles.hpp"

namespace headland::mcts {
namespace {

constexpr double kStep = 0.4;

VehicleState driven(const Manoeuvres& moves, const Vehicle& vehicle, VehicleState state,
                    const Action& action) {
  constexpr int kParts = 40;
  const double dt = kStep / kParts;
  for (int i = 0; i < kParts; ++i) {
    state = step_vehicle(vehicle, state, moves.command(vehicle, state, action, dt), dt);
  }
  return state;
}

TEST(Manoeuvres, LeadWhereTheVehicleGoes) {
  RandomStream random(1, "manoeuvres");
  for (Vehicle vehicle : {test::field_robot(), test::tractor(), test::rover()}) {
    vehicle.steering_lag_s = 0.0;
    vehicle.speed_lag_s = 0.0;
    const Manoeuvres moves(vehicle, kStep);
    for (int i = 0; i < 300; ++i) {
      VehicleState state;
      state.pose = {0.0, 0.0, random.uniform(-kPi, kPi)};
      state.speed = random.uniform(-0.5, 1.5);
      if (moves.ackermann()) {
        state.steering = random.uniform(-0.6, 0.6);
      } else {
        state.yaw_rate = random.uniform(-0.5, 0.5);
      }
      const Motion from = moves.from(state);
      const Action action = moves.action(from, random.index(Manoeuvres::kCount), 1.5);
      const VehicleState exact = driven(moves, vehicle, state, action);
      const VehicleState tree = moves.to_state(moves.drive(from, action));
      EXPECT_LT((tree.pose.position() - exact.pose.position()).norm(), 0.03) << vehicle.name;
      EXPECT_LT(std::abs(wrap_angle(tree.pose.yaw - exact.pose.yaw)), 0.05) << vehicle.name;
      EXPECT_NEAR(tree.speed, exact.speed, 1e-6);
    }
  }
}

TEST(Manoeuvres, KeepToTheVehiclesLimits) {
  RandomStream random(2, "limits");
  const Vehicle vehicle = test::field_robot();
  const Manoeuvres moves(vehicle, kStep);
  for (int i = 0; i < 2000; ++i) {
    Motion from;
    from.speed = random.uniform(-1.0, 1.5);
    from.turn = random.uniform(-vehicle.max_steering_rad(), vehicle.max_steering_rad());
    const Action action = moves.action(from, random.index(Manoeuvres::kCount), 1.2);
    EXPECT_LE(std::abs(action.speed - from.speed), vehicle.acceleration_mps2 * kStep + 1e-12);
    EXPECT_LE(std::abs(action.turn - from.turn), vehicle.steering_rate_radps * kStep + 1e-12);
    EXPECT_LE(std::abs(action.turn), vehicle.max_steering_rad());
    EXPECT_LE(action.speed, std::max(1.2, from.speed));
  }
}

TEST(Manoeuvres, ReverseOnlyWhereTheVehicleMay) {
  Vehicle vehicle = test::field_robot();
  const Motion still;
  EXPECT_LT(Manoeuvres(vehicle, kStep).action(still, 6, 1.0).speed, 0.0);
  vehicle.can_reverse = false;
  EXPECT_EQ(Manoeuvres(vehicle, kStep).action(still, 6, 1.0).speed, 0.0);
}

TEST(Manoeuvres, EachOrderNamesAllActionsTheFirstBeingItself) {
  for (int number = 0; number < Manoeuvres::kCount; ++number) {
    std::set<int> seen;
    for (int k = 0; k < Manoeuvres::kCount; ++k) seen.insert(Manoeuvres::nearest(number, k));
    EXPECT_EQ(Manoeuvres::nearest(number, 0), number);
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(Manoeuvres::kCount));
  }
}

}  // namespace
}  // namespace headland::mcts
