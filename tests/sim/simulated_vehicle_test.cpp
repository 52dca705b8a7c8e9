// SPDX-License-Identifier: Apache-2.0
#include "sim/simulated_vehicle.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

Vehicle rover() {
  Vehicle vehicle;
  vehicle.name = "rover";
  vehicle.steering = Steering::kDifferential;
  vehicle.min_turning_radius_m = 1.0;
  vehicle.acceleration_mps2 = 100.0;
  vehicle.battery = {10.0, 0.1, 100.0, 50.0, 20.0};
  return vehicle;
}

TEST(SimulatedVehicle, DrawsWhatDriveCostPlans) {
  Vehicle vehicle = rover();
  vehicle.work_speed_mps = 1.0;
  SimulatedVehicle sim(vehicle, {}, 1.0, {}, 1);
  for (int i = 0; i < 1000; ++i) sim.step({1.0, 0.0, 0.0}, LegKind::kRow, 0.01);
  const double distance = sim.truth().pose.x;
  EXPECT_NEAR(sim.drawn_j(), drive_cost(vehicle, LegKind::kRow, distance).energy_j, 2.0);
  EXPECT_NEAR(sim.soc(), 1.0 - sim.drawn_j() / vehicle.battery.capacity_j(), 1e-12);
}

TEST(SimulatedVehicle, ChargesToFullInTheTimeThePowerTakes) {
  SimulatedVehicle sim(rover(), {}, 0.5, {}, 1);
  EXPECT_NEAR(sim.charge_full(1800.0), 10.0, 1e-9);  // 5 Wh at 1.8 kW
  EXPECT_EQ(sim.soc(), 1.0);
}

TEST(SimulatedVehicle, FixesAreOffByAtMostTheAccuracy) {
  SimulatedVehicle sim(rover(), {3.0, 4.0, 0.0}, 1.0, {0.05, 0.0}, 1);
  double worst = 0.0;
  double sum = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const VehicleState fix = sim.measure();
    worst = std::max({worst, std::abs(fix.pose.x - 3.0), std::abs(fix.pose.y - 4.0)});
    sum += fix.pose.x - 3.0;
    EXPECT_EQ(fix.pose.yaw, 0.0);
  }
  EXPECT_LE(worst, 0.05);
  EXPECT_GT(worst, 0.049);
  EXPECT_NEAR(sum / 10000, 0.0, 0.001);
}

TEST(SimulatedVehicle, WithoutErrorsTheFixIsTheTruth) {
  SimulatedVehicle sim(rover(), {3.0, 4.0, 1.0}, 1.0, {}, 1);
  EXPECT_EQ(sim.measure().pose.x, sim.truth().pose.x);
  EXPECT_EQ(sim.measure().pose.yaw, sim.truth().pose.yaw);
}

}  // namespace
}  // namespace headland
