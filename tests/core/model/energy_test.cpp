// SPDX-License-Identifier: Apache-2.0
#include "core/model/energy.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

EnergyModel random_model(RandomStream& random) {
  EnergyModel m;
  m.mass_kg = random.uniform(50.0, 5000.0);
  m.payload_kg = random.uniform(0.0, 2000.0);
  m.rotating_mass_kg = random.uniform(0.0, 0.2) * m.mass_kg;
  m.rolling_factor_ratio = random.uniform(0.5, 3.0);
  m.drag_area_m2 = random.uniform(0.0, 4.0);
  m.turn_loss_ratio = random.uniform(0.0, 1.0);
  m.drive_efficiency_ratio = random.uniform(0.4, 1.0);
  m.recuperation_efficiency_ratio = random.uniform(0.0, 1.0);
  m.base_power_w = random.uniform(0.0, 500.0);
  m.implement_power_w = random.uniform(0.0, 2000.0);
  m.implement_draft_n = random.uniform(0.0, 0.3) * m.mass_kg * kGravity;
  return m;
}

SoilResistance random_soil(RandomStream& random) {
  return soil_resistance(static_cast<SoilClass>(random.index(5)));
}

// At constant speed.
DriveStep random_step(RandomStream& random) {
  DriveStep step;
  step.distance_m = random.uniform(0.01, 5.0);
  step.rise_m = random.uniform(-0.4, 0.4) * step.distance_m;
  step.speed_mps = random.uniform(0.1, 4.0);
  step.speed_before_mps = step.speed_mps;
  step.duration_s = step.distance_m / step.speed_mps;
  // No vehicle takes a bend at more than 2 m/s2, nor pulls so hard that slip reaches its bound.
  const double tightest = std::min(1.0, 2.0 / (step.speed_mps * step.speed_mps));
  step.curvature_1pm = random.uniform(-tightest, tightest);
  step.soil = random_soil(random);
  step.working = random.uniform() < 0.5;
  return step;
}

// `check(model, step, random)` for many models and steps.
template <class Check>
void for_many(Check check) {
  RandomStream random(42, "energy");
  for (int i = 0; i < 2000; ++i) {
    const EnergyModel model = random_model(random);
    check(model, random_step(random), random);
  }
}

TEST(StepEnergy, NothingMovedAndNoTimePassedCostsNothing) {
  for_many([](const EnergyModel& model, const DriveStep&, RandomStream&) {
    EXPECT_EQ(step_energy(model, DriveStep{}), 0.0);
  });
}

TEST(StepEnergy, StandingDrawsTheBaseLoad) {
  EnergyModel model;
  model.implement_power_w = 500.0;
  DriveStep step;
  step.duration_s = 10.0;
  EXPECT_DOUBLE_EQ(step_energy(model, step), 3000.0);
  step.working = true;
  EXPECT_DOUBLE_EQ(step_energy(model, step), 8000.0);
}

TEST(StepEnergy, AtConstantSpeedItGoesWithTheDistance) {
  for_many([](const EnergyModel& model, const DriveStep& step, RandomStream& random) {
    const double factor = random.uniform(1.0, 10.0);
    DriveStep more = step;
    more.distance_m *= factor;
    more.rise_m *= factor;
    more.duration_s *= factor;
    const double once = step_energy(model, step);
    EXPECT_NEAR(step_energy(model, more), factor * once, 1e-9 * (1.0 + std::abs(factor * once)));
  });
}

TEST(StepEnergy, GrowsWithSlopeCurvatureLoadAndWorseSoil) {
  for_many([](const EnergyModel& model, const DriveStep& step, RandomStream& random) {
    const double here = step_energy(model, step);
    const double rounding = 1e-9 * std::abs(here);
    DriveStep harder = step;
    harder.rise_m += random.uniform(0.0, 0.2) * step.distance_m;
    EXPECT_GE(step_energy(model, harder), here - rounding);
    harder = step;
    harder.curvature_1pm *= random.uniform(1.0, 3.0);
    EXPECT_GE(step_energy(model, harder), here - rounding);
    harder = step;
    harder.soil.rolling_ratio *= random.uniform(1.0, 3.0);
    harder.soil.slip_per_traction *= random.uniform(1.0, 3.0);
    EXPECT_GE(step_energy(model, harder), here - rounding);
    harder = step;
    harder.working = true;
    EXPECT_GE(step_energy(model, harder), here - rounding);
    EnergyModel heavier = model;
    heavier.implement_draft_n = 0.0;  // else the load adds grip: slip goes with draft over weight
    heavier.payload_kg += random.uniform(0.0, 1000.0);
    EnergyModel as_heavy = heavier;
    as_heavy.payload_kg = model.payload_kg;
    DriveStep uphill = step;
    uphill.rise_m = std::abs(step.rise_m);
    EXPECT_GE(step_energy(heavier, uphill), step_energy(as_heavy, uphill) - rounding);
  });
}

TEST(StepEnergy, GrowsAsEfficienciesFall) {
  for_many([](const EnergyModel& model, const DriveStep& step, RandomStream& random) {
    EnergyModel worse = model;
    worse.drive_efficiency_ratio *= random.uniform(0.3, 1.0);
    worse.recuperation_efficiency_ratio *= random.uniform(0.0, 1.0);
    EXPECT_GE(step_energy(worse, step), step_energy(model, step) - 1e-9);
  });
}

TEST(StepEnergy, IsNeverLessThanWhatTheSlopeCanGiveBack) {
  for_many([](const EnergyModel& model, const DriveStep& step, RandomStream&) {
    const double potential = model.recuperation_efficiency_ratio * model.total_mass() * kGravity;
    EXPECT_GE(step_energy(model, step), potential * step.rise_m - 1e-9);
    EnergyModel bare = model;
    bare.base_power_w = 0.0;
    bare.implement_power_w = 0.0;
    EXPECT_GE(step_energy(bare, step), potential * step.rise_m - 1e-9);
  });
}

TEST(StepEnergy, UpAndDownTogetherCostMoreThanLevelGround) {
  for_many([](const EnergyModel& model, const DriveStep& step, RandomStream&) {
    DriveStep level = step;
    DriveStep down = step;
    level.rise_m = 0.0;
    down.rise_m = -step.rise_m;
    EXPECT_GE(step_energy(model, step) + step_energy(model, down),
              2.0 * step_energy(model, level) - 1e-6);
  });
}

TEST(StepEnergy, SpeedingUpAndBrakingAgainLosesEnergy) {
  for_many([](const EnergyModel& model, const DriveStep& step, RandomStream& random) {
    DriveStep faster = step;
    DriveStep slower = step;
    faster.speed_before_mps = step.speed_mps * random.uniform(0.5, 1.0);
    slower.speed_mps = faster.speed_before_mps;
    slower.speed_before_mps = step.speed_mps;
    // Energy kept in the motion is given back with the recuperation's efficiency at best.
    DriveStep coasting = slower;
    coasting.speed_before_mps = slower.speed_mps;
    EXPECT_GE(step_energy(model, faster) + step_energy(model, slower),
              step_energy(model, step) + step_energy(model, coasting) - 1e-6);
  });
}

TEST(StepEnergy, SlipTakesItsShareAndStopsGrowingWhereTheVehicleIsStuck) {
  EnergyModel model;
  model.base_power_w = 0.0;
  DriveStep step;
  step.distance_m = 10.0;
  step.rise_m = 1.0;
  step.soil = {0.05, 0.0};
  const double without = step_energy(model, step);
  EXPECT_NEAR(without, 1000.0 * kGravity * 1.5 / 0.8, 1e-6);
  step.soil.slip_per_traction = 0.2;
  EXPECT_NEAR(step_energy(model, step), without / (1.0 - 0.2 * 0.15), 1e-6);
  step.soil.slip_per_traction = 100.0;
  EXPECT_NEAR(step_energy(model, step), without / 0.5, 1e-6);
}

TEST(StepEnergy, AirAndTurningAreWhatTheirFormulasSay) {
  EnergyModel model;
  model.base_power_w = 0.0;
  model.drive_efficiency_ratio = 1.0;
  DriveStep step;
  step.distance_m = 3.0;
  step.speed_mps = 4.0;
  step.speed_before_mps = 4.0;
  step.curvature_1pm = -0.2;
  step.soil = {};
  EXPECT_EQ(step_energy(model, step), 0.0);
  model.drag_area_m2 = 2.0;
  EXPECT_NEAR(step_energy(model, step), 0.5 * 1.2041 * 2.0 * 16.0 * 3.0, 1e-9);
  model.drag_area_m2 = 0.0;
  model.turn_loss_ratio = 0.3;
  EXPECT_NEAR(step_energy(model, step), 0.3 * 1000.0 * 16.0 * 0.2 * 3.0, 1e-9);
}

TEST(StepEnergy, IsTheWorkAtTheWheelsOverWhatSlipAndDriveLeave) {
  for_many([](const EnergyModel& model, const DriveStep& step, RandomStream&) {
    const double work = wheel_work(model, step);
    const double load = step_energy(model, step) - step_energy(model, [&] {
                          DriveStep instant = step;
                          instant.duration_s = 0.0;
                          return instant;
                        }());
    const double drawn = step_energy(model, step) - load;
    const double traction = traction_ratio(model, step);
    EXPECT_NEAR(traction * model.total_mass() * kGravity * step.distance_m, work,
                1e-12 * std::abs(work));
    const double slip = std::min(0.5, step.soil.slip_per_traction * traction);
    const double expected = work > 0.0 ? work / (1.0 - slip) / model.drive_efficiency_ratio
                                       : work * model.recuperation_efficiency_ratio;
    EXPECT_NEAR(drawn, expected, 1e-9 * (std::abs(expected) + load));
  });
  EXPECT_EQ(traction_ratio({}, {}), 0.0);
}

TEST(StepEnergy, ExcessSlipCostsTheWayTheWheelsRollInVain) {
  EnergyModel model;
  model.base_power_w = 0.0;
  model.drive_efficiency_ratio = 1.0;
  DriveStep step;
  step.distance_m = 1.0;
  const double slip = step.soil.slip_per_traction * traction_ratio(model, step);
  step.excess_slip_ratio = 0.2;
  EXPECT_NEAR(step_energy(model, step), wheel_work(model, step) / (1.0 - slip - 0.2), 1e-9);
  step.excess_slip_ratio = 0.9;
  EXPECT_NEAR(step_energy(model, step), wheel_work(model, step) / 0.5, 1e-9);
}

TEST(WheelPower, IsTheDrivesShareOfTheEnergyPerTimeAndZeroWhereItBrakes) {
  for_many([](const EnergyModel& model, const DriveStep& step, RandomStream&) {
    EnergyModel bare = model;
    bare.base_power_w = 0.0;
    bare.implement_power_w = 0.0;
    const double drawn = step_energy(bare, step);
    const double expected = std::max(0.0, drawn) * model.drive_efficiency_ratio / step.duration_s;
    EXPECT_NEAR(wheel_power(model, step), expected, 1e-9 * (1.0 + expected));
  });
}

}  // namespace
}  // namespace headland
