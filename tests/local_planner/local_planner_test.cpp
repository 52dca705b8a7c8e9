// SPDX-License-Identifier: Apache-2.0
#include "local_planner/local_planner.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/local_planner/planner_laws.hpp"

namespace headland::test {
namespace {

// Counts how often it is asked.
class Asked : public LocalPlanner {
 public:
  explicit Asked(const Vehicle& vehicle) : LocalPlanner(vehicle) {}
  int count = 0;

 protected:
  void do_plan(const LocalScene& scene, const LocalGoal&, const PlanBudget&,
               LocalPlan& plan) override {
    ++count;
    brake(vehicle(), scene.robot.state, scene.time_s, LocalStatus::kPlanned, plan);
  }
};

TEST(LocalPlanner, IsNotAskedWhereItWouldPlanByNoNumbersOrOldScenes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double old = 1.01 * LocalPlanner::kOldestScene;
  const LocalGoal goal{nullptr, 0.0, {9.0, 0.0}, 1.0, 1.0};
  const std::vector<Agent> lost = {agent_at(3.0, 0.0), agent_at(nan, 0.0)};
  VehicleState state;
  state.speed = 1.0;
  VehicleState unknown = state;
  unknown.pose.yaw = nan;
  LocalGoal nowhere = goal;
  nowhere.place.x() = nan;
  LocalGoal still = goal;
  still.speed_mps = 0.0;
  Asked planner(field_robot());
  LocalPlan plan;
  const auto status = [&](const LocalScene& scene, const LocalGoal& to) {
    planner.plan(scene, to, {}, plan);
    EXPECT_GE(plan.states.size(), 2U);
    for (const VehicleState& s : plan.states) EXPECT_TRUE(is_finite(s));
    EXPECT_EQ(plan.states.back().speed < 0.05, true);
    return plan.status;
  };
  EXPECT_EQ(status({0.0, unknown, {}, nullptr, 0.0}, goal), LocalStatus::kBadInput);
  EXPECT_EQ(status({nan, state, {}, nullptr, 0.0}, goal), LocalStatus::kBadInput);
  EXPECT_EQ(status({0.0, state, lost, nullptr, 0.0}, goal), LocalStatus::kBadInput);
  EXPECT_EQ(status({0.0, state, {}, nullptr, nan}, goal), LocalStatus::kBadInput);
  EXPECT_EQ(status({0.0, state, {}, nullptr, 0.0}, nowhere), LocalStatus::kBadInput);
  EXPECT_EQ(status({0.0, state, {}, nullptr, 0.0}, still), LocalStatus::kBadInput);
  EXPECT_EQ(status({0.0, state, {}, nullptr, old}, goal), LocalStatus::kStale);
  EXPECT_EQ(planner.count, 0);
  EXPECT_EQ(status({0.0, state, {}, nullptr, 0.9 * LocalPlanner::kOldestScene}, goal),
            LocalStatus::kPlanned);
  EXPECT_EQ(planner.count, 1);
}

TEST(LocalPlan, BetweenItsStepsTheVehicleTurnsTheShortWay) {
  LocalPlan plan;
  plan.states.resize(2);
  plan.states[0].pose.yaw = kPi - 0.1;
  plan.states[1].pose.yaw = -kPi + 0.1;
  EXPECT_NEAR(plan.at(0.05).pose.yaw, kPi, 1e-12);
  EXPECT_NEAR(plan.at(-1.0).pose.yaw, kPi - 0.1, 1e-12);
}

TEST(LocalPlanner, BrakingCanBeDriven) {
  LocalPlan plan;
  for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
    for (const double speed : {-1.5, -0.2, 0.0, 0.7, 2.0}) {
      const VehicleState state{{1.0, 2.0, 3.0}, speed, 0.3, 0.2 * speed};
      brake(vehicle, state, 7.0, LocalStatus::kBraking, plan);
      EXPECT_TRUE(is_drivable(vehicle, {7.0, state, {}, nullptr, 0.0}, plan)) << vehicle.name;
      EXPECT_LT(std::abs(plan.states.back().speed), 0.01);
      EXPECT_EQ(plan.begin_s, 7.0);
    }
  }
}

}  // namespace
}  // namespace headland::test
