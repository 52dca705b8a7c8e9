// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "global_planner/mission/internal/tour_model.hpp"
#include "global_planner/mission/mission_plan.hpp"
#include "global_planner/tour/tour_solver.hpp"

namespace headland {
namespace {

// A block of eight 60 m rows, a yard beside it, a charger at either side.
Farm farm() {
  Farm farm;
  RowParcel parcel;
  parcel.id = "p";
  parcel.boundary = {{{0.0, 0.0}, {80.0, 0.0}, {80.0, 40.0}, {0.0, 40.0}}, {}};
  parcel.row_spacing_m = 4.0;
  for (int r = 0; r < 8; ++r) {
    const double y = 6.0 + 4.0 * r;
    parcel.rows.push_back({"r" + std::to_string(r + 1), {{10.0, y}, {70.0, y}}});
  }
  farm.row_parcels.push_back(parcel);
  farm.free_parcels.push_back(
      {"yard", {{{-30.0, 0.0}, {1.0, 0.0}, {1.0, 40.0}, {-30.0, 40.0}}, {}}});
  farm.pois.push_back({"dock-a", "dock", {-20.0, 10.0, 0.0}});
  farm.pois.push_back({"dock-b", "dock", {-20.0, 25.0, 0.0}});
  farm.pois.push_back({"sample", "soil_sample", {-10.0, 33.0, 0.0}});
  farm.chargers.push_back({"c1", {-12.0, 17.0, 0.0}, ChargeCurve(5000.0), 1});
  return farm;
}

Vehicle robot() {
  Vehicle v;
  v.name = "robot";
  v.steering = Steering::kDifferential;
  v.min_turning_radius_m = 1.0;
  v.work_speed_mps = 1.0;
  v.transit_speed_mps = 1.5;
  v.turn_speed_mps = 0.8;
  v.footprint = {0.8, 0.8, 1.2};
  v.energy.mass_kg = 500.0;
  v.energy.base_power_w = 200.0;
  v.energy.implement_power_w = 300.0;
  v.battery.reserve_soc = 0.1;
  return v;
}

Mission mission(double capacity_wh, int vehicles) {
  Mission m;
  m.config.name = "test";
  m.config.planner.roadmap_samples = 0;
  m.farm = farm();
  for (int v = 0; v < vehicles; ++v) {
    MissionVehicleConfig config;
    config.id = v == 0 ? "a" : "b";
    config.model = "robot";
    m.config.vehicles.push_back(config);
    MissionVehicle vehicle;
    vehicle.id = config.id;
    vehicle.vehicle = robot();
    vehicle.vehicle.battery.capacity_wh = capacity_wh;
    vehicle.start = vehicle.finish = m.farm.pois[static_cast<std::size_t>(v)].pose;
    m.vehicles.push_back(vehicle);
  }
  m.rows = m.farm.all_rows();
  m.row_terms.resize(m.rows.size());
  return m;
}

// Metres worked of each row.
std::map<std::string, double> worked(const MissionPlan& plan) {
  std::map<std::string, double> metres;
  for (const VehiclePlan& vehicle : plan.vehicles) {
    for (const PlanLeg& leg : vehicle.legs) {
      if (leg.kind == LegKind::kRow) metres[leg.id] += leg.cost.length_m;
    }
  }
  return metres;
}

void expect_sound(const MissionPlan& plan) {
  for (const VehiclePlan& vehicle : plan.vehicles) {
    const double reserve = vehicle.vehicle.battery.reserve_soc;
    EXPECT_GE(vehicle.min_soc, reserve - 1e-9) << vehicle.id;
    EXPECT_GE(vehicle.min_margin_j, -1e-6) << vehicle.id;
    double soc = vehicle.start_soc;
    double time = 0.0;
    for (const PlanLeg& leg : vehicle.legs) {
      if (leg.kind == LegKind::kCharge) {
        EXPECT_GE(leg.soc_end, soc);
      } else {
        EXPECT_NEAR(leg.soc_end, soc - leg.cost.energy_j / vehicle.vehicle.battery.capacity_j(),
                    1e-9);
      }
      soc = leg.soc_end;
      EXPECT_GE(leg.begin_s, time - 1e-6) << leg.id;
      time = leg.begin_s + leg.cost.duration_s;
    }
    EXPECT_LE(time, vehicle.finish_s + 1e-6);
  }
}

TEST(FleetPlan, TwoVehiclesShareTheRowsWhenTimeCounts) {
  Mission m = mission(5000.0, 2);
  m.config.objective = Objective::kTime;
  const auto plan = plan_mission(m);
  ASSERT_TRUE(plan) << to_string(plan.error());
  expect_sound(*plan);
  EXPECT_EQ(worked(*plan).size(), 8u);
  for (const VehiclePlan& vehicle : plan->vehicles) EXPECT_FALSE(vehicle.legs.empty());
  Mission alone = mission(5000.0, 1);
  alone.config.objective = Objective::kTime;
  const auto single = plan_mission(alone);
  ASSERT_TRUE(single) << to_string(single.error());
  EXPECT_LT(plan->makespan_s, 0.7 * single->makespan_s);
}

TEST(FleetPlan, OneSlotIsNeverHeldByTwo) {
  Mission m = mission(45.0, 2);
  m.config.objective = Objective::kTime;
  const auto plan = plan_mission(m);
  ASSERT_TRUE(plan) << to_string(plan.error());
  expect_sound(*plan);
  std::vector<std::pair<double, double>> held;
  for (const VehiclePlan& vehicle : plan->vehicles) {
    for (const PlanLeg& leg : vehicle.legs) {
      if (leg.kind == LegKind::kCharge) {
        held.emplace_back(leg.begin_s, leg.begin_s + leg.cost.duration_s);
      }
    }
  }
  std::sort(held.begin(), held.end());
  EXPECT_GE(held.size(), 2u);
  for (std::size_t i = 1; i < held.size(); ++i) {
    EXPECT_GE(held[i].first, held[i - 1].second - 1e-6);
  }
}

TEST(FleetPlan, ARowLongerThanTheBatteryIsSplitAndResumedAtThatMetre) {
  const auto plan = plan_mission(mission(30.0, 1));
  ASSERT_TRUE(plan) << to_string(plan.error());
  expect_sound(*plan);
  std::map<std::string, std::set<double>> cuts;
  for (const PlanLeg& leg : plan->vehicles.front().legs) {
    if (leg.kind != LegKind::kRow || leg.from_m == leg.to_m) continue;
    EXPECT_NEAR(std::abs(leg.to_m - leg.from_m), leg.cost.length_m, 1e-6);
    cuts[leg.id].insert(leg.from_m);
    cuts[leg.id].insert(leg.to_m);
  }
  EXPECT_FALSE(cuts.empty());
  for (const auto& [row, metres] : worked(*plan)) EXPECT_NEAR(metres, 60.0, 1e-6) << row;
}

TEST(FleetPlan, TooLittleTimeDropsTheLeastValuableRowsByName) {
  Mission m = mission(5000.0, 1);
  m.vehicles.front().shift_s = 500.0;
  const auto impossible = plan_mission(m);
  ASSERT_FALSE(impossible);
  EXPECT_EQ(exit_code(impossible.error().code), 3);
  m.config.allow_dropping = true;
  m.row_terms[2].value = 5.0;
  const auto plan = plan_mission(m);
  ASSERT_TRUE(plan) << to_string(plan.error());
  expect_sound(*plan);
  EXPECT_LE(plan->makespan_s, 500.0);
  EXPECT_EQ(plan->dropped.size() + worked(*plan).size(), 8u);
  ASSERT_FALSE(plan->dropped.empty());
  EXPECT_TRUE(worked(*plan).contains("p/r3"));
  for (const DroppedWork& work : plan->dropped) {
    EXPECT_EQ(work.id.rfind("row p/r", 0), 0u) << work.id;
    EXPECT_FALSE(work.reason.empty());
  }
}

TEST(FleetPlan, PlacesAreVisitedForTheirDwellTime) {
  Mission m = mission(5000.0, 1);
  m.visits.push_back({2, 1.0, 45.0, {}});
  const auto plan = plan_mission(m);
  ASSERT_TRUE(plan) << to_string(plan.error());
  expect_sound(*plan);
  int visits = 0;
  for (const PlanLeg& leg : plan->vehicles.front().legs) {
    if (leg.kind != LegKind::kTask) continue;
    ++visits;
    EXPECT_EQ(leg.id, "sample");
    EXPECT_EQ(leg.cost.duration_s, 45.0);
  }
  EXPECT_EQ(visits, 1);
}

TEST(FleetPlan, EveryChargeStopHasAReason) {
  const auto plan = plan_mission(mission(120.0, 1));
  ASSERT_TRUE(plan) << to_string(plan.error());
  EXPECT_GE(plan->charge_stops, 1);
  EXPECT_EQ(static_cast<int>(plan->reasons.size()), plan->charge_stops);
  for (const PlanReason& reason : plan->reasons) {
    EXPECT_NE(reason.text.find("kWh at c1"), std::string::npos) << reason.text;
  }
}

TEST(FleetPlan, SolutionsOfItsTourProblemPassTheCheck) {
  for (const double capacity_wh : {30.0, 45.0, 120.0}) {
    for (const int vehicles : {1, 2}) {
      for (const Objective objective : {Objective::kEnergy, Objective::kTime}) {
        Mission m = mission(capacity_wh, vehicles);
        m.config.objective = objective;
        const auto model = mission::TourModel::build(m);
        ASSERT_TRUE(model) << to_string(model.error());
        const auto solution = solve_tour(model->problem());
        ASSERT_TRUE(solution) << to_string(solution.error());
        EXPECT_EQ(check_solution(model->problem(), *solution).value_or(""), "")
            << capacity_wh << " Wh, " << vehicles << " vehicles";
      }
    }
  }
}

}  // namespace
}  // namespace headland
