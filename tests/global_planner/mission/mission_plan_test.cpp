// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/mission_plan.hpp"

#include <set>

#include <gtest/gtest.h>

#include "core/config/yaml.hpp"

namespace headland {
namespace {

const std::filesystem::path kMissions =
    std::filesystem::path(HEADLAND_SOURCE_DIR) / "config/missions";

MissionConfig kiato(double capacity_wh) {
  MissionConfig config;
  config.name = "test";
  config.farm = {"../farms/kiato_vineyard.geojson"};
  MissionVehicleConfig vehicle;
  vehicle.id = "carob";
  vehicle.model = "../vehicles/carob.yaml";
  vehicle.start.poi = "dock";
  vehicle.capacity_wh = capacity_wh;
  config.vehicles = {vehicle};
  return config;
}

Result<MissionPlan> plan(const MissionConfig& config) {
  const auto mission = load_mission(config, kMissions);
  if (!mission) return tl::unexpected<Error>(mission.error());
  return plan_mission(*mission);
}

TEST(MissionPlan, DrivesEveryRowOnceAndEndsWhereItShould) {
  const auto mission = load_mission(kiato(20000.0), kMissions);
  ASSERT_TRUE(mission);
  const auto found = plan_mission(*mission);
  ASSERT_TRUE(found) << to_string(found.error());
  const VehiclePlan& vehicle = found->vehicles.front();
  std::multiset<std::string> driven;
  for (const PlanLeg& leg : vehicle.legs) {
    if (leg.kind == LegKind::kRow) driven.insert(leg.id);
  }
  std::multiset<std::string> wanted;
  for (const RowRef row : mission->rows) wanted.insert(mission->farm.row_name(row));
  EXPECT_EQ(driven, wanted);
  ASSERT_EQ(vehicle.stages.size(), 1u);
  const Pose2 start = vehicle.stages.front().path.start_pose();
  const Pose2 end = vehicle.stages.back().path.end_pose();
  EXPECT_LT((start.position() - mission->vehicles.front().start.position()).norm(), 1e-6);
  EXPECT_LT((end.position() - mission->vehicles.front().finish.position()).norm(), 1e-6);
  EXPECT_EQ(found->charge_stops, 0);
}

TEST(MissionPlan, TotalsAreTheSumsOfTheLegs) {
  const auto found = plan(kiato(20000.0));
  ASSERT_TRUE(found) << to_string(found.error());
  const VehiclePlan& vehicle = found->vehicles.front();
  double energy = 0.0;
  double length = 0.0;
  for (const PlanLeg& leg : vehicle.legs) {
    energy += leg.cost.energy_j;
    length += leg.cost.length_m;
  }
  EXPECT_NEAR(energy, vehicle.energy_j, 1e-6 * energy);
  EXPECT_NEAR(energy, found->value, 1e-6 * energy);
  EXPECT_NEAR(length, vehicle.stages.front().path.length(), 1e-3);
  EXPECT_NEAR(length, found->work_m + found->turn_m + found->transit_m, 1e-6);
  EXPECT_LE(found->lower_bound, found->value);
  EXPECT_LE(found->gap_ratio(), 0.03);
}

TEST(MissionPlan, RechargesBeforeTheReserveIsTouched) {
  const auto found = plan(kiato(600.0));
  ASSERT_TRUE(found) << to_string(found.error());
  EXPECT_GE(found->charge_stops, 2);
  const VehiclePlan& vehicle = found->vehicles.front();
  EXPECT_GE(vehicle.min_soc, vehicle.vehicle.battery.reserve_soc - 1e-9);
  for (const PlanLeg& leg : vehicle.legs) {
    EXPECT_GE(leg.soc_end, vehicle.vehicle.battery.reserve_soc - 1e-9) << leg.id;
    if (leg.kind == LegKind::kCharge) {
      EXPECT_GT(leg.cost.duration_s, 0.0);
    }
  }
  EXPECT_EQ(vehicle.stages.size(), static_cast<std::size_t>(found->charge_stops) + 1);
}

TEST(MissionPlan, ALargerBatteryNeverCostsMore) {
  const auto small = plan(kiato(600.0));
  const auto large = plan(kiato(4000.0));
  ASSERT_TRUE(small && large);
  EXPECT_LE(large->value, small->value + 1e-6);
}

TEST(MissionPlan, ABatteryTooSmallForOneRowIsInfeasibleByName) {
  const auto found = plan(kiato(40.0));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::kEnergyInfeasible);
  EXPECT_NE(to_string(found.error()).find("Wh"), std::string::npos) << to_string(found.error());
}

TEST(MissionPlan, SameSeedSamePlan) {
  const auto a = plan(kiato(1500.0));
  const auto b = plan(kiato(1500.0));
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->vehicles.front().legs.size(), b->vehicles.front().legs.size());
  for (std::size_t i = 0; i < a->vehicles.front().legs.size(); ++i) {
    EXPECT_EQ(a->vehicles.front().legs[i].id, b->vehicles.front().legs[i].id);
    EXPECT_EQ(a->vehicles.front().legs[i].cost.energy_j, b->vehicles.front().legs[i].cost.energy_j);
  }
}

TEST(MissionPlan, EachObjectiveWinsInItsOwnUnit) {
  const auto with = [](Objective objective) {
    MissionConfig config = kiato(20000.0);
    config.objective = objective;
    return plan(config);
  };
  const auto energy = with(Objective::kEnergy);
  const auto time = with(Objective::kTime);
  const auto length = with(Objective::kLength);
  ASSERT_TRUE(energy && time && length);
  const auto total = [](const MissionPlan& p, auto part) {
    double sum = 0.0;
    for (const PlanLeg& leg : p.vehicles.front().legs) sum += part(leg.cost);
    return sum;
  };
  const auto length_of = [](const DriveCost& c) { return c.length_m; };
  const auto time_of = [](const DriveCost& c) { return c.duration_s; };
  // Both are searched, not proven, so a little slack.
  EXPECT_LE(total(*length, length_of), 1.01 * total(*energy, length_of));
  EXPECT_LE(total(*time, time_of), 1.01 * total(*energy, time_of));
}

}  // namespace
}  // namespace headland
