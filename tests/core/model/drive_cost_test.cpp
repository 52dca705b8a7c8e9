// SPDX-License-Identifier: Apache-2.0
#include "core/model/drive_cost.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

Vehicle vehicle() {
  Vehicle v;
  v.work_speed_mps = 2.0;
  v.turn_speed_mps = 1.0;
  v.transit_speed_mps = 4.0;
  v.gear_change_s = 3.0;
  v.energy.mass_kg = 100.0;
  v.energy.drive_efficiency_ratio = 0.5;
  v.energy.base_power_w = 100.0;
  v.energy.implement_power_w = 60.0;
  return v;
}

TEST(DriveCost, AddsRollingBaseAndImplement) {
  // Firm soil: 0.05 of the weight, and slip of 0.16 of that.
  const double rolling = 0.05 * 100.0 * 9.80665 / (1.0 - 0.16 * 0.05) / 0.5;
  const DriveCost row = drive_cost(vehicle(), LegKind::kRow, 100.0);
  EXPECT_DOUBLE_EQ(row.duration_s, 50.0);
  EXPECT_NEAR(row.energy_j, 100.0 * rolling + 160.0 * 50.0, 1e-9);
  const DriveCost transit = drive_cost(vehicle(), LegKind::kTransit, 100.0);
  EXPECT_NEAR(transit.energy_j, 100.0 * rolling + 100.0 * 25.0, 1e-9);
}

TEST(DriveCost, PeakOfASumIsTheHighestPointOnTheWay) {
  const DriveCost up{100.0, 50.0, 900.0, 900.0};
  const DriveCost down{100.0, 50.0, -500.0, 0.0};
  EXPECT_DOUBLE_EQ((up + down).peak_j, 900.0);
  EXPECT_DOUBLE_EQ((down + up).peak_j, 400.0);
  EXPECT_DOUBLE_EQ((up + down).energy_j, 400.0);
}

TEST(DriveCost, GearChangesCostTimeAndBasePower) {
  const DriveCost smooth = drive_cost(vehicle(), LegKind::kTurn, 10.0);
  const DriveCost cusps = drive_cost(vehicle(), LegKind::kTurn, 10.0, 2);
  EXPECT_DOUBLE_EQ(cusps.duration_s - smooth.duration_s, 6.0);
  EXPECT_DOUBLE_EQ(cusps.energy_j - smooth.energy_j, 600.0);
}

TEST(DriveCost, NothingDrivenCostsNothingAndMoreCostsMore) {
  for (const LegKind kind : {LegKind::kRow, LegKind::kTurn, LegKind::kTransit}) {
    EXPECT_EQ(drive_cost(vehicle(), kind, 0.0).energy_j, 0.0);
    EXPECT_GT(drive_cost(vehicle(), kind, 11.0).energy_j,
              drive_cost(vehicle(), kind, 10.0).energy_j);
  }
}

}  // namespace
}  // namespace headland
