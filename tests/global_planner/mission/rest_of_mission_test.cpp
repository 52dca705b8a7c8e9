// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/rest_of_mission.hpp"

#include <set>

#include <gtest/gtest.h>

namespace headland {
namespace {

VehiclePlan four_legs() {
  VehiclePlan plan;
  plan.vehicle.battery.capacity_wh = 1.0;  // 3600 J
  plan.vehicle.battery.reserve_soc = 0.25;
  for (const double energy : {400.0, 800.0, -200.0}) {
    PlanLeg leg;
    leg.kind = LegKind::kTransit;
    leg.cost.energy_j = energy;
    plan.legs.push_back(leg);
  }
  PlanLeg charge;
  charge.kind = LegKind::kCharge;
  plan.legs.push_back(charge);
  plan.legs.push_back(plan.legs[1]);
  return plan;
}

TEST(SpareEnergy, IsWhatTheLowestMomentBeforeTheNextChargeLeaves) {
  const VehiclePlan plan = four_legs();
  EXPECT_NEAR(spare_energy(plan, {0, 0.0}, 1.0), 3600.0 - 1200.0 - 900.0, 1e-9);
  EXPECT_NEAR(spare_energy(plan, {0, 0.5}, 1.0), 3600.0 - 1000.0 - 900.0, 1e-9);
  EXPECT_NEAR(spare_energy(plan, {2, 0.0}, 0.5), 1800.0 - 900.0, 1e-9) << "downhill";
  EXPECT_NEAR(spare_energy(plan, {4, 0.25}, 0.4), 1440.0 - 600.0 - 900.0, 1e-9) << "negative";
  EXPECT_NEAR(spare_energy(plan, {1, 0.0}, 1.0, 0.1), 3600.0 - 880.0 - 900.0, 1e-9) << "margin";
}

const std::filesystem::path kMissions =
    std::filesystem::path(HEADLAND_SOURCE_DIR) / "config/missions";

Mission kiato() {
  MissionConfig config;
  config.name = "test";
  config.farm = {"../farms/kiato_vineyard.geojson"};
  MissionVehicleConfig vehicle;
  vehicle.id = "carob";
  vehicle.model = "../vehicles/carob.yaml";
  vehicle.start.poi = "dock";
  vehicle.capacity_wh = 20000.0;
  config.vehicles = {vehicle};
  return load_mission(config, kMissions).value();
}

std::multiset<std::string> rows_from(const VehiclePlan& plan, std::size_t leg) {
  std::multiset<std::string> rows;
  for (; leg < plan.legs.size(); ++leg) {
    if (plan.legs[leg].kind == LegKind::kRow) rows.insert(plan.legs[leg].id);
  }
  return rows;
}

TEST(RestOfMission, PlansTheRowsThatAreLeftFromWhereTheVehicleStands) {
  const Mission mission = kiato();
  const VehiclePlan plan = plan_mission(mission).value().vehicles.front();
  std::size_t row = 0;  // the second row's leg
  for (int seen = 0; row < plan.legs.size(); ++row) {
    if (plan.legs[row].kind == LegKind::kRow && ++seen == 2) break;
  }
  const auto [begin, end] = plan.stages.front().path.leg_range(static_cast<int>(row));
  EXPECT_GT(end, begin);
  const Standing standing{plan.stages.front().path.at(end + 2.0).pose, 0.5, 100.0,
                          static_cast<int>(row) + 1};
  const auto anew = replan(mission, 0, plan, standing);
  ASSERT_TRUE(anew) << to_string(anew.error());
  EXPECT_EQ(rows_from(*anew, 0), rows_from(plan, row + 1));
  EXPECT_LT((anew->stages.front().path.start_pose().position() - standing.pose.position()).norm(),
            1e-6);
  EXPECT_LT((anew->stages.back().path.end_pose().position() -
             plan.stages.back().path.end_pose().position())
                .norm(),
            1e-6);
  EXPECT_NEAR(anew->start_soc, 0.5, 1e-12);
}

TEST(RestOfMission, LeavesRowsOutForWhichTheChargeIsTooLow) {
  const Mission mission = kiato();
  const VehiclePlan plan = plan_mission(mission).value().vehicles.front();
  const double reserve = plan.vehicle.battery.reserve_soc;
  const double soc = reserve + 0.5 * plan.energy_j / plan.vehicle.battery.capacity_j();
  const auto anew = replan(mission, 0, plan, {plan.start, soc, 0.0, 0});
  ASSERT_TRUE(anew) << to_string(anew.error());
  EXPECT_LT(rows_from(*anew, 0).size(), rows_from(plan, 0).size());
  EXPECT_GT(rows_from(*anew, 0).size(), 0u);
  EXPECT_GE(anew->min_soc, reserve - 1e-9);
}

TEST(RestOfMission, WithNothingLeftThereIsNothingToPlan) {
  const Mission mission = kiato();
  const VehiclePlan plan = plan_mission(mission).value().vehicles.front();
  const auto rest =
      rest_of_mission(mission, 0, plan, {plan.start, 1.0, 0.0, static_cast<int>(plan.legs.size())});
  ASSERT_FALSE(rest);
  EXPECT_EQ(rest.error().code, ErrorCode::kNoRows);
}

}  // namespace
}  // namespace headland
