// SPDX-License-Identifier: Apache-2.0
// Plans that are driven where people and animals are about.
#include <cmath>

#include <gtest/gtest.h>

#include "sim/lab/closed_loop.hpp"
#include "tests/support/rover.hpp"

namespace headland {
namespace {

Vehicle rover() {
  Vehicle vehicle = test::rover();
  vehicle.footprint = {0.8, 0.8, 1.0};
  vehicle.battery.capacity_wh = 500.0;
  vehicle.battery.reserve_soc = 0.1;
  vehicle.energy.mass_kg = 300.0;
  vehicle.energy.base_power_w = 200.0;
  return vehicle;
}

FreeParcel parcel(const char* id, const Point2& low, const Point2& high) {
  return {id, {{low, {high.x(), low.y()}, high, {low.x(), high.y()}}, {}}};
}

// A meadow, and a spot of it in the middle of the way.
Farm meadow() {
  Farm farm;
  farm.free_parcels = {parcel("meadow", {-10.0, -20.0}, {80.0, 20.0}),
                       parcel("spot", {29.7, -0.3}, {30.3, 0.3})};
  return farm;
}

// Straight on for 60 m, in equal legs.
VehiclePlan straight_on(LegKind kind, int legs = 1) {
  VehiclePlan plan;
  plan.id = "rover";
  plan.vehicle = rover();
  PlanStage stage;
  for (int i = 0; i < legs; ++i) {
    const double length = 60.0 / legs;
    stage.path.append_straight(i == 0 ? Pose2{} : stage.path.end_pose(), length, i);
    plan.legs.push_back(
        {kind, "p/" + std::to_string(i), drive_cost(plan.vehicle, kind, length), 1.0, 0});
  }
  plan.stages.push_back(stage);
  return plan;
}

SimulationConfig with(const AgentGroupConfig& group) {
  SimulationConfig config;
  config.step_s = 0.05;
  config.agents.groups = {group};
  return config;
}

// Stands in the way, and does not move for anybody.
AgentGroupConfig somebody_in_the_way() {
  AgentGroupConfig group;
  group.behaviour = Behaviour::kIgnore;
  group.parcel = "spot";
  group.speed_mps = 0.0;
  return group;
}

AgentGroupConfig walkers(int count) {
  AgentGroupConfig group;
  group.count = count;
  group.parcel = "meadow";
  return group;
}

FleetRun drive(const VehiclePlan& plan, const SimulationConfig& config,
               const RunHooks& hooks = {}) {
  return drive_fleet({plan}, {}, meadow(), Ground(), config, hooks).value();
}

TEST(AgentsAbout, TheVehicleLeavesItsPathForSomebodyAndComesBack) {
  const FleetRun run = drive(straight_on(LegKind::kTransit), with(somebody_in_the_way()));
  const EncounterMetrics& e = run.metrics.encounters;
  EXPECT_TRUE(run.metrics.completed) << run.metrics.reason;
  EXPECT_EQ(e.takeovers, 1);
  EXPECT_EQ(e.collisions, 0);
  EXPECT_GT(e.least_gap_m, 0.3);
  double farthest = 0.0;
  for (const TraceRow& row : run.vehicles.front().trace) {
    if (row.driving == Driving::kLocal) farthest = std::max(farthest, std::abs(row.cross_track_m));
  }
  EXPECT_GT(farthest, 0.8);
  EXPECT_EQ(run.vehicles.front().trace.back().driving, Driving::kPath);
  EXPECT_LT(std::abs(run.vehicles.front().trace.back().cross_track_m), 0.05);
}

TEST(AgentsAbout, RowsAreNotLeftSomebodyInThemIsWaitedFor) {
  const FleetRun run = drive(straight_on(LegKind::kRow), with(somebody_in_the_way()));
  const EncounterMetrics& e = run.metrics.encounters;
  EXPECT_FALSE(run.metrics.completed);
  EXPECT_NE(run.metrics.reason.find("does not get on"), std::string::npos) << run.metrics.reason;
  EXPECT_EQ(e.takeovers, 0);
  EXPECT_GE(e.protective_stops, 1);
  EXPECT_EQ(e.collisions, 0);
  EXPECT_LT(run.metrics.tracking.max_m, 0.05);
}

TEST(AgentsAbout, NobodyIsDrivenInto) {
  int takeovers = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SimulationConfig config = with(walkers(60));
    config.seed = seed;
    const FleetRun run = drive(straight_on(LegKind::kTransit), config);
    EXPECT_TRUE(run.metrics.completed) << run.metrics.reason;
    EXPECT_EQ(run.metrics.encounters.robot_collisions, 0) << seed;
    takeovers += run.metrics.encounters.takeovers;
  }
  EXPECT_GE(takeovers, 5);
}

TEST(AgentsAbout, TheVehicleStandsWhileItSeesNothing) {
  SimulationConfig config = with(walkers(1));
  config.local.sight.lost_from_s = 10.0;
  config.local.sight.lost_until_s = 20.0;
  const FleetRun run = drive(straight_on(LegKind::kTransit), config);
  EXPECT_TRUE(run.metrics.completed) << run.metrics.reason;
  double fastest_before = 0.0;
  for (const TraceRow& row : run.vehicles.front().trace) {
    if (row.t_s < 10.0) fastest_before = std::max(fastest_before, row.speed_mps);
    if (row.t_s > 12.5 && row.t_s < 20.0) {
      EXPECT_LT(std::abs(row.speed_mps), 0.05) << row.t_s;
    }
  }
  EXPECT_GT(fastest_before, 0.9);
  EXPECT_EQ(run.metrics.encounters.protective_stops, 1);
}

TEST(AgentsAbout, TheSameSeedGivesTheSameRun) {
  SimulationConfig config = with(walkers(40));
  const VehiclePlan plan = straight_on(LegKind::kTransit);
  const auto one = drive(plan, config).vehicles.front().trace;
  const auto two = drive(plan, config).vehicles.front().trace;
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].x_m, two[i].x_m);
    ASSERT_EQ(one[i].y_m, two[i].y_m);
  }
  config.seed = 2;
  EXPECT_NE(drive(plan, config).vehicles.front().trace.size(), one.size());
}

TEST(AgentsAbout, GroupsOfNobodyChangeNothing) {
  const VehiclePlan plan = straight_on(LegKind::kTransit);
  SimulationConfig alone;
  alone.step_s = 0.05;
  const auto without = drive(plan, alone).vehicles.front().trace;
  const FleetRun with_none = drive(plan, with(walkers(0)));
  EXPECT_TRUE(with_none.agents.empty());
  ASSERT_EQ(with_none.vehicles.front().trace.size(), without.size());
  EXPECT_EQ(with_none.vehicles.front().trace.back().x_m, without.back().x_m);
}

TEST(AgentsAbout, AGroupInAParcelThatDoesNotExistIsAnError) {
  AgentGroupConfig lost = walkers(1);
  lost.parcel = "moon";
  const auto run =
      drive_fleet({straight_on(LegKind::kTransit)}, {}, meadow(), Ground(), with(lost));
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, ErrorCode::kUnknownName);
}

// Two rows of work are left when the charge will not last for both: only the first is kept.
TEST(AgentsAbout, WhatIsLeftIsPlannedAnewWhenTheReserveIsAtRisk) {
  VehiclePlan plan = straight_on(LegKind::kTransit, 6);
  plan.legs[4].kind = LegKind::kRow;
  plan.legs[5].kind = LegKind::kRow;
  double needed = 0.0;
  for (const PlanLeg& leg : plan.legs) needed += leg.cost.energy_j;
  const Battery& battery = plan.vehicle.battery;
  plan.start_soc = battery.reserve_soc + (needed - 1.0) / battery.capacity_j();
  std::vector<Standing> asked;
  RunHooks hooks;
  hooks.replan = [&](std::size_t vehicle, const VehiclePlan& driven,
                     const Standing& standing) -> Result<VehiclePlan> {
    EXPECT_EQ(vehicle, 0u);
    asked.push_back(standing);
    VehiclePlan anew = driven;
    anew.legs = {plan.legs[4]};
    anew.stages.resize(1);
    anew.stages[0].path = {};
    anew.stages[0].path.append_straight(standing.pose, 10.0, 0);
    return anew;
  };
  const FleetRun run = drive(plan, with(walkers(1)), hooks);
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].next_leg, 1);
  EXPECT_EQ(run.metrics.replans, 1);
  const VehiclePlan& driven = run.vehicles.front().driven;
  ASSERT_EQ(driven.legs.size(), 2u);
  EXPECT_EQ(driven.legs[1].id, "p/4");
  EXPECT_EQ(run.metrics.rows_total, 2);
  EXPECT_EQ(run.metrics.rows_done, 1);
  EXPECT_TRUE(run.metrics.reserve_kept);
  EXPECT_NE(run.metrics.reason.find("left out"), std::string::npos) << run.metrics.reason;
  EXPECT_EQ(run.vehicles.front().trace.back().leg, 1);
}

TEST(AgentsAbout, APlanWithoutAnAnswerIsKept) {
  VehiclePlan plan = straight_on(LegKind::kTransit, 3);
  plan.start_soc = 0.101;
  RunHooks hooks;
  hooks.replan = [](std::size_t, const VehiclePlan&, const Standing&) -> Result<VehiclePlan> {
    return tl::unexpected<Error>({ErrorCode::kEnergyInfeasible, "no", "", {}});
  };
  const FleetRun run = drive(plan, with(walkers(1)), hooks);
  EXPECT_GE(run.metrics.failed_replans, 1);
  EXPECT_EQ(run.metrics.replans, 0);
  EXPECT_EQ(run.vehicles.front().driven.legs.size(), 3u);
}

// A leg that begins within a minute of the last attempt is checked when that minute is over.
TEST(AgentsAbout, TheReserveOfEachLegIsChecked) {
  VehiclePlan plan = straight_on(LegKind::kTransit, 3);
  plan.vehicle.transit_speed_mps = 0.5;
  plan.start_soc = 0.101;
  std::vector<Standing> asked;
  RunHooks hooks;
  hooks.replan = [&](std::size_t, const VehiclePlan&,
                     const Standing& standing) -> Result<VehiclePlan> {
    if (asked.empty() || standing.time_s > asked.back().time_s) asked.push_back(standing);
    return tl::unexpected<Error>({ErrorCode::kEnergyInfeasible, "no", "", {}});
  };
  drive(plan, with(walkers(1)), hooks);
  ASSERT_GE(asked.size(), 2u);
  EXPECT_EQ(asked[1].next_leg, 2);
  EXPECT_NEAR(asked[1].time_s, asked[0].time_s + 60.0, 0.2);
}

TEST(AgentsAbout, ARunThatIsStoppedTellsWhatItDrove) {
  int looks = 0;
  RunHooks hooks;
  hooks.stop = [&] { return ++looks > 200; };
  SimulationConfig config;
  config.step_s = 0.05;
  const FleetRun run = drive(straight_on(LegKind::kTransit), config, hooks);
  EXPECT_FALSE(run.metrics.completed);
  EXPECT_NE(run.metrics.reason.find("it was stopped"), std::string::npos) << run.metrics.reason;
  EXPECT_NEAR(run.metrics.duration_s, 10.0, 0.2);
  EXPECT_GT(run.vehicles.front().trace.back().s_m, 5.0);
}

}  // namespace
}  // namespace headland
