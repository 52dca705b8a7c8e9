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
  v.battery.base_power_w = 100.0;
  v.battery.work_j_per_m = 50.0;
  v.battery.transit_j_per_m = 20.0;
  return v;
}

TEST(DriveCost, AddsBasePowerAndWorkPerMetre) {
  const DriveCost row = drive_cost(vehicle(), LegKind::kRow, 100.0);
  EXPECT_DOUBLE_EQ(row.duration_s, 50.0);
  EXPECT_DOUBLE_EQ(row.energy_j, 50.0 * 100.0 + 100.0 * 50.0);
  const DriveCost transit = drive_cost(vehicle(), LegKind::kTransit, 100.0);
  EXPECT_DOUBLE_EQ(transit.energy_j, 25.0 * 100.0 + 100.0 * 20.0);
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
