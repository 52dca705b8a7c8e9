// SPDX-License-Identifier: Apache-2.0
#include "sim/simulated_vehicle.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace headland {
namespace {

constexpr double kCycle = 0.02;

Vehicle rover() {
  Vehicle vehicle;
  vehicle.name = "rover";
  vehicle.steering = Steering::kDifferential;
  vehicle.min_turning_radius_m = 1.0;
  vehicle.acceleration_mps2 = 100.0;
  vehicle.energy.mass_kg = 200.0;
  vehicle.energy.drive_efficiency_ratio = 0.8;
  vehicle.energy.recuperation_efficiency_ratio = 0.5;
  vehicle.energy.base_power_w = 40.0;
  vehicle.battery.capacity_wh = 1000.0;
  return vehicle;
}

// z = slope x, 400 x 100 m.
Ground ramp(double slope) {
  std::vector<double> heights;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 5; ++column) heights.push_back(slope * 100.0 * (column - 2));
  }
  return {Farm{}, Terrain::from_grid({-200.0, -50.0}, 100.0, 5, 2, heights)};
}

// Drives straight ahead at a speed for some steps of 20 ms.
void drive(SimulatedVehicle& sim, double speed, int steps) {
  for (int i = 0; i < steps; ++i) sim.step({speed, 0.0, 0.0}, LegKind::kTransit);
}

TEST(SimulatedVehicle, DrawsWhatPathCostPlansOnceItHasItsSpeed) {
  Vehicle vehicle = rover();
  vehicle.transit_speed_mps = 1.0;
  for (const double slope : {0.0, 0.05, -0.02, -0.2}) {
    const Ground ground = ramp(slope);
    SimulatedVehicle sim(vehicle, {-100.0, 0.0, 0.0}, 0.5, {}, 1, kCycle, ground);
    drive(sim, 1.0, 50);
    const double drawn = sim.drawn_j();
    Path path;
    path.append_straight(sim.truth().pose, 60.0, 0);
    drive(sim, 1.0, 3000);
    const auto planned = path_cost(vehicle, ground, path, LegKind::kTransit);
    EXPECT_NEAR(sim.drawn_j() - drawn, planned->energy_j, 1e-6 * 60.0 * 200.0);
    EXPECT_NEAR(sim.height(), slope * sim.truth().pose.x, 1e-4);
    EXPECT_NEAR(sim.soc(), 0.5 - sim.drawn_j() / vehicle.battery.capacity_j(), 1e-12);
  }
}

TEST(SimulatedVehicle, SpeedingUpCostsAndBrakingGivesPartOfItBack) {
  Vehicle vehicle = rover();
  vehicle.acceleration_mps2 = 1.0;
  vehicle.energy.base_power_w = 0.0;
  vehicle.energy.rolling_factor_ratio = 1e-9;
  SimulatedVehicle sim(vehicle, {}, 0.5, {}, 1, kCycle);
  drive(sim, 2.0, 200);
  const double kinetic = 0.5 * 200.0 * 4.0;
  EXPECT_GT(sim.drawn_j(), kinetic / 0.8);
  EXPECT_LT(sim.drawn_j(), 1.05 * kinetic / 0.8);  // slip of the acceleration
  const double fast = sim.drawn_j();
  drive(sim, 0.0, 200);
  EXPECT_NEAR(sim.drawn_j() - fast, -0.5 * kinetic, 1e-3);
}

TEST(SimulatedVehicle, CurvesCostTheTurnLoss) {
  Vehicle vehicle = rover();
  vehicle.acceleration_mps2 = 100.0;
  const auto drawn_at = [&vehicle](double yaw_rate) {
    SimulatedVehicle sim(vehicle, {}, 1.0, {}, 1, kCycle);
    for (int i = 0; i < 500; ++i) sim.step({1.0, 0.0, yaw_rate}, LegKind::kTurn);
    return sim.drawn_j();
  };
  EXPECT_NEAR(drawn_at(0.5), drawn_at(0.0), 1e-6);
  vehicle.energy.turn_loss_ratio = 0.5;
  // c m v^2 |kappa| over 10 m, and a little slip.
  EXPECT_NEAR(drawn_at(0.5) - drawn_at(0.0), 0.5 * 200.0 * 0.5 * 10.0 / 0.8, 20.0);
  EXPECT_NEAR(drawn_at(-0.5), drawn_at(0.5), 1e-6);
}

TEST(SimulatedVehicle, SoilsAreFelt) {
  Farm farm;
  farm.soils.push_back(
      {"dune", SoilClass::kSand, {{{-9.0, -9.0}, {90.0, -9.0}, {90.0, 9.0}, {-9.0, 9.0}}, {}}});
  SimulatedVehicle firm(rover(), {}, 1.0, {}, 1, kCycle);
  SimulatedVehicle sand(rover(), {}, 1.0, {}, 1, kCycle, Ground(farm, std::nullopt));
  drive(firm, 1.0, 500);
  drive(sand, 1.0, 500);
  EXPECT_GT(sand.drawn_j(), 2.0 * firm.drawn_j());
}

TEST(SimulatedVehicle, AFullBatteryTakesNoMore) {
  SimulatedVehicle sim(rover(), {-100.0, 0.0, 0.0}, 1.0, {}, 1, kCycle, ramp(-0.3));
  drive(sim, 1.0, 2000);
  EXPECT_EQ(sim.soc(), 1.0);
  EXPECT_GE(sim.drawn_j(), 0.0);
  EXPECT_LT(sim.drawn_j(), 1.0);
}

TEST(SimulatedVehicle, BeyondTheTerrainItGoesOnAtTheLastHeight) {
  SimulatedVehicle sim(rover(), {190.0, 0.0, 0.0}, 0.5, {}, 1, kCycle, ramp(0.1));
  drive(sim, 1.0, 2000);
  EXPECT_GT(sim.truth().pose.x, 220.0);
  EXPECT_NEAR(sim.height(), 20.0, 0.01);
}

TEST(SimulatedVehicle, ChargesByTheCurve) {
  SimulatedVehicle sim(rover(), {}, 0.5, {}, 1, kCycle);
  EXPECT_NEAR(sim.charge(ChargeCurve(1800.0), 0.75), 500.0, 1e-9);  // 250 Wh at 1.8 kW
  EXPECT_NEAR(sim.soc(), 0.75, 1e-15);
  const ChargeCurve slow = ChargeCurve::cc_cv(1800.0, 0.8, 0.1);
  const double expected = slow.time(0.75, 1.0, 3.6e6);
  EXPECT_NEAR(sim.charge(slow, 1.0), expected, 1e-9);
  EXPECT_GT(expected, 500.0);
  EXPECT_EQ(sim.soc(), 1.0);
  EXPECT_EQ(sim.charge(slow, 0.5), 0.0);
  EXPECT_EQ(sim.soc(), 1.0);
  sim.draw(3600.0);
  EXPECT_NEAR(sim.soc(), 0.999, 1e-12);
  EXPECT_EQ(sim.drawn_j(), 3600.0);
}

TEST(SimulatedVehicle, FixesAreOffByAtMostTheAccuracy) {
  SimulatedVehicleConfig fixes;
  fixes.sensors.position_accuracy_m = 0.05;
  SimulatedVehicle sim(rover(), {3.0, 4.0, 0.0}, 1.0, fixes, 1, kCycle);
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
  SimulatedVehicle sim(rover(), {3.0, 4.0, 1.0}, 1.0, {}, 1, kCycle);
  EXPECT_EQ(sim.measure().pose.x, sim.truth().pose.x);
  EXPECT_EQ(sim.measure().pose.yaw, sim.truth().pose.yaw);
}

Vehicle tractor() {
  Vehicle vehicle;
  vehicle.name = "tractor";
  vehicle.energy.mass_kg = 1000.0;
  return vehicle;
}

// A command for each step, with reversing and both turns.
Command command_at(int step) {
  const double t = kCycle * step;
  return {1.5 * std::cos(0.4 * t), 0.4 * std::sin(0.7 * t), 0.5 * std::sin(0.9 * t)};
}

bool same(const VehicleState& a, const VehicleState& b) {
  return a.pose.x == b.pose.x && a.pose.y == b.pose.y && a.pose.yaw == b.pose.yaw &&
         a.speed == b.speed && a.steering == b.steering && a.yaw_rate == b.yaw_rate;
}

TEST(SimulatedVehicle, WithoutSlipItMovesAsStepVehicleToTheBit) {
  for (const Vehicle& vehicle : {tractor(), rover()}) {
    SimulatedVehicle sim(vehicle, {1.0, 2.0, 0.3}, 1.0, {}, 1, kCycle, ramp(0.1));
    VehicleState state;
    state.pose = {1.0, 2.0, 0.3};
    for (int i = 0; i < 2000; ++i) {
      sim.step(command_at(i), LegKind::kTransit);
      state = step_vehicle(vehicle, state, command_at(i), kCycle);
      ASSERT_TRUE(same(sim.truth(), state)) << i;
    }
  }
}

TEST(SimulatedVehicle, ConstantSlipIsThatOfStepVehicle) {
  SimulatedVehicleConfig config;
  config.slip.loss_ratio = 0.1;
  config.slip.side_deg = 3.0;
  config.slip.steering_offset_deg = 2.0;
  const Slip slip{0.1, deg_to_rad(3.0), deg_to_rad(2.0)};
  for (const Vehicle& vehicle : {tractor(), rover()}) {
    SimulatedVehicle sim(vehicle, {}, 1.0, config, 1, kCycle);
    VehicleState state;
    for (int i = 0; i < 2000; ++i) {
      sim.step(command_at(i), LegKind::kTransit);
      const double yaw = state.pose.yaw;
      state = step_vehicle(vehicle, state, command_at(i), kCycle, slip);
      ASSERT_TRUE(same(sim.truth(), state)) << i;
      EXPECT_EQ(sim.yaw_rate(), wrap_angle(state.pose.yaw - yaw) / kCycle);
    }
    EXPECT_EQ(sim.slip().side_rad, slip.side_rad);
  }
}

TEST(SimulatedVehicle, DeadTimesActBeforeTheLags) {
  Vehicle vehicle = tractor();
  vehicle.speed_dead_time_s = 0.2;
  vehicle.steering_dead_time_s = 0.4;
  vehicle.speed_lag_s = 0.3;
  vehicle.steering_lag_s = 0.1;
  SimulatedVehicle sim(vehicle, {}, 1.0, {}, 1, kCycle);
  VehicleState state;
  for (int i = 0; i < 500; ++i) {
    sim.step({1.0, 0.3, 0.0}, LegKind::kTransit);
    const Command acting{i < 10 ? 0.0 : 1.0, i < 20 ? 0.0 : 0.3, 0.0};
    state = step_vehicle(vehicle, state, acting, kCycle);
    ASSERT_TRUE(same(sim.truth(), state)) << i;
  }
}

TEST(SimulatedVehicle, DriftsDownhillForwardAndInReverse) {
  SimulatedVehicleConfig config;
  config.slip.terrain_factor_ratio = 1.0;
  for (const Vehicle& vehicle : {tractor(), rover()}) {
    for (const double speed : {1.0, -1.0}) {
      for (const double yaw : {0.5 * kPi, -0.5 * kPi}) {
        // Along the contour of z = 0.2 x: downhill is west.
        SimulatedVehicle sim(vehicle, {0.0, 0.0, yaw}, 1.0, config, 1, kCycle, ramp(0.2));
        drive(sim, speed, 1000);
        EXPECT_NEAR(sim.truth().pose.x, -0.16 * 0.2 * sim.distance(), 0.002 * sim.distance());
        EXPECT_NEAR(sim.truth().pose.yaw, yaw, 1e-9);
        EXPECT_NEAR(sim.distance(), 20.0 * (1.0 - 0.16 * 0.05), 0.6);
      }
    }
  }
}

TEST(SimulatedVehicle, DrawsForTheWayOfItsWheels) {
  // The work at the wheels is the traction over the way that they roll, slip of any origin in it.
  Vehicle vehicle = rover();
  vehicle.energy.base_power_w = 0.0;
  for (const double slope : {0.0, 0.1}) {
    for (const double constant : {0.0, 0.2}) {
      SimulatedVehicleConfig config;
      config.slip.terrain_factor_ratio = 1.0;
      config.slip.loss_ratio = constant;
      SimulatedVehicle sim(vehicle, {-50.0, 0.0, 0.0}, 0.5, config, 1, kCycle, ramp(slope));
      drive(sim, 1.0, 50);
      const double before = sim.drawn_j();
      const double x = sim.truth().pose.x;
      drive(sim, 1.0, 2000);
      const double traction = 200.0 * kGravity * (0.05 + slope);
      const double rolled = 1.0 * 2000 * kCycle;
      EXPECT_NEAR(sim.drawn_j() - before, traction * rolled / 0.8, 2e-5 * traction * rolled);
      EXPECT_NEAR(sim.truth().pose.x - x, rolled * (1.0 - sim.slip().loss_ratio), 1e-6);
      EXPECT_NEAR(sim.slip().loss_ratio, constant + 0.16 * (0.05 + slope), 1e-6);
    }
  }
}

TEST(SimulatedVehicle, TerrainSlipDrawsWhatPathCostPlans) {
  Vehicle vehicle = rover();
  vehicle.energy.base_power_w = 0.0;  // slip takes time, which plans do not know
  vehicle.transit_speed_mps = 1.0;
  SimulatedVehicleConfig config;
  config.slip.terrain_factor_ratio = 1.0;
  for (const double slope : {0.0, 0.05, 0.2, -0.2}) {
    const Ground ground = ramp(slope);
    SimulatedVehicle sim(vehicle, {-100.0, 0.0, 0.0}, 0.5, config, 1, kCycle, ground);
    drive(sim, 1.0, 50);
    const double drawn = sim.drawn_j();
    Path path;
    const Pose2 from = sim.truth().pose;
    drive(sim, 1.0, 2000);
    path.append_straight(from, sim.truth().pose.x - from.x, 0);
    const auto planned = path_cost(vehicle, ground, path, LegKind::kTransit);
    EXPECT_NEAR(sim.drawn_j() - drawn, planned->energy_j, 1e-5 * 200.0 * 60.0);
  }
}

TEST(SimulatedVehicle, AStepOfTheSlipDoesNoWork) {
  Vehicle vehicle = rover();
  vehicle.energy.base_power_w = 0.0;
  SimulatedVehicleConfig config;
  config.slip.changes = {{5.0, 0.4, 0.0, 0.0}};
  SimulatedVehicle sim(vehicle, {}, 0.5, config, 1, kCycle);
  drive(sim, 1.0, 50);
  for (int i = 0; i < 1000; ++i) {
    const double before = sim.drawn_j();
    drive(sim, 1.0, 1);
    const double step = 200.0 * kGravity * 0.05 * kCycle / 0.8;  // at the wheels, about
    EXPECT_NEAR(sim.drawn_j() - before, step, 0.02 * step) << i;
  }
  EXPECT_EQ(sim.slip().loss_ratio, 0.4);
}

TEST(SimulatedVehicle, SameSeedSameBytesAndSlipDoesNotChangeTheNoise) {
  SimulatedVehicleConfig config;
  config.slip.terrain_factor_ratio = 1.0;
  config.slip.walk.loss_ratio = 0.05;
  config.slip.walk.side_deg = 2.0;
  config.sensors.position_accuracy_m = 0.02;
  config.sensors.gnss.noise_m = 0.01;
  config.sensors.gnss.latency_s = 0.1;
  SimulatedVehicleConfig still = config;
  still.slip = {};
  SimulatedVehicle a(tractor(), {}, 1.0, config, 11, kCycle, ramp(0.1));
  SimulatedVehicle b(tractor(), {}, 1.0, config, 11, kCycle, ramp(0.1));
  SimulatedVehicle c(tractor(), {}, 1.0, still, 11, kCycle, ramp(0.1));
  for (int i = 0; i < 500; ++i) {
    for (SimulatedVehicle* sim : {&a, &b, &c}) sim->step(command_at(i), LegKind::kRow);
    ASSERT_TRUE(same(a.truth(), b.truth()));
    const double now = kCycle * (i + 1);
    const auto one = a.sense(now);
    const auto two = b.sense(now);
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t k = 0; k < one.size(); ++k) EXPECT_EQ(one[k].value, two[k].value);
    const double error = a.measure().pose.x - a.truth().pose.x;
    EXPECT_NEAR(error, c.measure().pose.x - c.truth().pose.x, 1e-12);
  }
  EXPECT_EQ(a.drawn_j(), b.drawn_j());
  EXPECT_GT((a.truth().pose.position() - c.truth().pose.position()).norm(), 0.01);
}

TEST(SimulatedVehicle, TheGyroscopeFeelsTheSlip) {
  SimulatedVehicleConfig config;
  config.slip.steering_offset_deg = 5.0;
  SimulatedVehicle sim(tractor(), {}, 1.0, config, 1, kCycle);
  drive(sim, 1.0, 200);
  for (const Measurement& m : sim.sense(4.0)) {
    if (m.kind == MeasurementKind::kYawRate) {
      EXPECT_NEAR(m.value[0], std::tan(deg_to_rad(5.0)) / 2.0, 1e-9);
    }
    if (m.kind == MeasurementKind::kTurn) {
      EXPECT_EQ(m.value[0], 0.0);
    }
  }
}

}  // namespace
}  // namespace headland
