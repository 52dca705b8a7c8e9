// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/closed_loop.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/rover.hpp"

namespace headland {
namespace {

Vehicle rover() {
  Vehicle vehicle = test::rover();
  vehicle.battery.capacity_wh = 100.0;
  vehicle.battery.reserve_soc = 0.1;
  vehicle.energy.mass_kg = 600.0;
  vehicle.energy.base_power_w = 50.0;
  vehicle.energy.implement_power_w = 200.0;
  return vehicle;
}

// Two rows of 20 m joined by a half circle.
VehiclePlan two_rows(double start_soc = 1.0) {
  VehiclePlan plan;
  plan.id = "rover";
  plan.vehicle = rover();
  plan.start_soc = start_soc;
  PlanStage stage;
  stage.path.append_straight({0.0, 0.0, 0.0}, 20.0, 0);
  Curve turn;
  turn.add({0.5, 2.0 * kPi});
  stage.path.append(turn, {20.0, 0.0, 0.0}, 1);
  stage.path.append_straight(stage.path.end_pose(), 20.0, 2);
  plan.stages.push_back(stage);
  const auto leg = [&](LegKind kind, const char* id, double length) {
    plan.legs.push_back({kind, id, drive_cost(plan.vehicle, kind, length), 1.0, 0});
  };
  leg(LegKind::kRow, "p/r1", 20.0);
  leg(LegKind::kTurn, "turn", 2.0 * kPi);
  leg(LegKind::kRow, "p/r2", 20.0);
  return plan;
}

Run drive_plan(const VehiclePlan& plan, const SimulationConfig& config = {}) {
  return drive_fleet({plan}, {}, Farm{}, Ground(), config).value().vehicles.front();
}

TEST(ClosedLoop, DrivesAllRowsCloseToThePathAtTheEnergyPlanned) {
  const VehiclePlan plan = two_rows();
  const auto run = drive_plan(plan);
  EXPECT_TRUE(run.metrics.completed) << run.metrics.reason;
  EXPECT_EQ(run.metrics.rows_done, 2);
  EXPECT_EQ(run.metrics.rows_total, 2);
  EXPECT_LT(run.metrics.tracking.max_m, 0.02);
  EXPECT_EQ(run.metrics.wrong_gear_count, 0);
  double planned = 0.0;
  for (const PlanLeg& leg : plan.legs) planned += leg.cost.energy_j;
  EXPECT_NEAR(run.metrics.energy_j, planned, 0.05 * planned);
}

TEST(ClosedLoop, KeepsToThePowerOfTheDrive) {
  VehiclePlan plan = two_rows();
  const auto strong = drive_plan(plan);
  plan.vehicle.energy.drive_power_w = 150.0;
  const auto weak = drive_plan(plan);
  EXPECT_TRUE(weak.metrics.completed) << weak.metrics.reason;
  // On firm ground a constant force: the speed at which it takes that power.
  DriveStep step;
  step.distance_m = step.speed_mps = step.speed_before_mps = step.duration_s = 1.0;
  step.working = true;
  const double most = 150.0 / wheel_power(plan.vehicle.energy, step);
  ASSERT_LT(most, plan.vehicle.work_speed_mps);
  double fastest = 0.0;
  for (const TraceRow& row : weak.trace) fastest = std::max(fastest, row.speed_mps);
  EXPECT_NEAR(fastest, most, 1e-6);
  EXPECT_GT(weak.metrics.duration_s, strong.metrics.duration_s);
}

TEST(ClosedLoop, FallingBelowTheReserveIsNotASuccess) {
  const auto run = drive_plan(two_rows(0.11));
  EXPECT_FALSE(run.metrics.completed);
  EXPECT_FALSE(run.metrics.reserve_kept);
  EXPECT_NE(run.metrics.reason.find("below the reserve"), std::string::npos) << run.metrics.reason;
}

TEST(ClosedLoop, AnEmptyBatteryEndsTheRunOnTheRowItStopsIn) {
  const auto run = drive_plan(two_rows(0.03));
  EXPECT_FALSE(run.metrics.completed);
  EXPECT_EQ(run.metrics.rows_done, 0);
  EXPECT_NE(run.metrics.reason.find("the battery is empty"), std::string::npos)
      << run.metrics.reason;
  EXPECT_NE(run.metrics.reason.find("p/r1"), std::string::npos) << run.metrics.reason;
}

TEST(ClosedLoop, ARowDrivenOffItsLineIsNotDone) {
  SimulationConfig config;
  config.row_tolerance_m = 1e-6;
  config.sensors.position_accuracy_m = 0.05;
  const auto run = drive_plan(two_rows(), config);
  EXPECT_FALSE(run.metrics.completed);
  EXPECT_EQ(run.metrics.rows_done, 0);
}

RunHooks with_clock(const Clock& clock) {
  RunHooks hooks;
  hooks.clock = &clock;
  return hooks;
}

// Runs ahead by a second at every look, but for one in so many pairs of looks (begin, deadline).
class BusyClock : public Clock {
 public:
  explicit BusyClock(int quick_every) : quick_every_(quick_every) {}
  double now() const override {
    const bool quick = quick_every_ > 0 && looks_++ / 2 % quick_every_ == 0;
    return now_ += quick ? 0.0 : 1.0;
  }

 private:
  int quick_every_;
  mutable long looks_ = 0;
  mutable double now_ = 0.0;
};

TEST(ClosedLoop, HoldsTheTrackersDeadlineAgainstTheClockItIsGiven) {
  SimulationConfig config;
  config.step_s = 0.05;
  config.control.tracker = TrackerKind::kRhmc;
  const VehiclePlan plan = two_rows();
  EXPECT_EQ(drive_plan(plan, config).metrics.stale_plan_count, 0);
  config.control.rhmc.deadline_s = 0.5;
  const BusyClock always(0);
  const RunMetrics late = drive_fleet({plan}, {}, Farm{}, Ground(), config, with_clock(always))
                              .value()
                              .vehicles.front()
                              .metrics;
  EXPECT_FALSE(late.completed);
  EXPECT_NE(late.reason.find("solver failed"), std::string::npos) << late.reason;
  const BusyClock mostly(3);
  const RunMetrics some = drive_fleet({plan}, {}, Farm{}, Ground(), config, with_clock(mostly))
                              .value()
                              .vehicles.front()
                              .metrics;
  EXPECT_TRUE(some.completed) << some.reason;
  EXPECT_GT(some.stale_plan_count, 100);
}

TEST(ClosedLoop, SameSeedSameTraceOtherSeedOtherTrace) {
  SimulationConfig config;
  config.sensors.position_accuracy_m = 0.02;
  const auto a = drive_plan(two_rows(), config);
  const auto b = drive_plan(two_rows(), config);
  config.seed = 2;
  const auto c = drive_plan(two_rows(), config);
  ASSERT_EQ(a.trace.size(), b.trace.size());
  bool differs = false;
  for (std::size_t i = 0; i < a.trace.size(); ++i) {
    ASSERT_EQ(a.trace[i].x_m, b.trace[i].x_m);
    ASSERT_EQ(a.trace[i].yaw_rad, b.trace[i].yaw_rad);
    differs = differs || i >= c.trace.size() || a.trace[i].y_m != c.trace[i].y_m;
  }
  EXPECT_TRUE(differs);
}

// Five metres to a charger, a charge, five metres on.
VehiclePlan by_way_of_charger(const char* id, double y) {
  VehiclePlan plan;
  plan.id = id;
  plan.vehicle = rover();
  plan.start = {0.0, y, 0.0};
  plan.start_soc = 0.5;
  const DriveCost drive = drive_cost(plan.vehicle, LegKind::kTransit, 5.0);
  plan.legs = {{LegKind::kTransit, "there", drive, 0.5, 0},
               {LegKind::kCharge, "c", {0.0, 36.0, 0.0, 0.0}, 0.6, 0},
               {LegKind::kTransit, "on", drive, 0.6, 0}};
  plan.stages.resize(2);
  plan.stages[0].path.append_straight(plan.start, 5.0, 0);
  plan.stages[0].stop_leg = 1;
  plan.stages[1].path.append_straight({5.0, y, 0.0}, 5.0, 2);
  return plan;
}

TEST(ClosedLoop, VehiclesQueueForTheSlotOfACharger) {
  Farm farm;
  farm.chargers.push_back({"c", {5.0, 0.0, 0.0}, ChargeCurve(1000.0), 1});
  const std::vector<VehiclePlan> plans{by_way_of_charger("a", 0.0), by_way_of_charger("b", 2.0)};
  const FleetRun one_slot = drive_fleet(plans, {}, farm, Ground(), {}).value();
  EXPECT_TRUE(one_slot.metrics.completed) << one_slot.metrics.reason;
  EXPECT_EQ(one_slot.metrics.charges, 2);
  EXPECT_EQ(one_slot.vehicles[0].metrics.waited_s, 0.0);
  // 10 % of 100 Wh and what the way took, at 1 kW.
  EXPECT_NEAR(one_slot.vehicles[1].metrics.waited_s, 36.0, 8.0);
  farm.chargers.front().slots = 2;
  const FleetRun two_slots = drive_fleet(plans, {}, farm, Ground(), {}).value();
  EXPECT_EQ(two_slots.metrics.waited_s, 0.0);
  EXPECT_LT(two_slots.metrics.duration_s, one_slot.metrics.duration_s);
  const std::vector<FleetTick> ticks = fleet_ticks(one_slot, 0.1);
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    EXPECT_LE(one_slot.vehicles[ticks[i - 1].vehicle].trace[ticks[i - 1].tick].t_s,
              one_slot.vehicles[ticks[i].vehicle].trace[ticks[i].tick].t_s);
  }
}

TEST(TraceTicks, KeepFirstAndLastAndThePeriod) {
  std::vector<TraceRow> trace(1001);
  for (std::size_t i = 0; i < trace.size(); ++i) trace[i].t_s = 0.02 * static_cast<double>(i);
  const std::vector<int> ticks = trace_ticks(trace, 0.1);
  EXPECT_EQ(ticks.front(), 0);
  EXPECT_EQ(ticks.back(), 1000);
  EXPECT_EQ(ticks.size(), 201u);
  EXPECT_EQ(trace_ticks(trace, 0.0).size(), trace.size());
  EXPECT_TRUE(trace_ticks({}, 0.1).empty());
}

}  // namespace
}  // namespace headland
