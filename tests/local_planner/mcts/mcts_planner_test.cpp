// SPDX-License-Identifier: Apache-2.0
#include "local_planner/mcts/mcts_planner.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "local_planner/prediction/constant_velocity.hpp"
#include "local_planner/prediction/orca_predictor.hpp"
#include "tests/local_planner/episode.hpp"
#include "tests/local_planner/planner_laws.hpp"

namespace headland {
namespace {

using test::drive;
using test::Walker;

// Goes on by one second each time it is read.
class CountingClock : public Clock {
 public:
  double now() const override { return time_ += 0.01; }

 private:
  mutable double time_ = 0.0;
};

class StillClock : public Clock {
 public:
  double now() const override { return 0.0; }
};

bool same_states(const LocalPlan& a, const LocalPlan& b) {
  return std::equal(a.states.begin(), a.states.end(), b.states.begin(), b.states.end(),
                    [](const VehicleState& x, const VehicleState& y) {
                      return x.pose.x == y.pose.x && x.pose.y == y.pose.y &&
                             x.pose.yaw == y.pose.yaw && x.speed == y.speed;
                    });
}

LocalGoal straight_on(double x, double accuracy = 1.0) {
  return {nullptr, 0.0, {x, 0.0}, accuracy, 1.2};
}

TEST(MctsPlanner, ObeysTheLawsOfPlanners) {
  test::expect_planner_laws(
      [](const Vehicle& vehicle) { return std::make_unique<MctsPlanner>(vehicle, MctsConfig{}); },
      {60, {}});
}

TEST(MctsPlanner, ObeysThemWithAPredictorThatReacts) {
  test::expect_plans_repeat(
      [](const Vehicle& vehicle) {
        return std::make_unique<MctsPlanner>(vehicle, MctsConfig{},
                                             std::make_unique<OrcaPredictor>());
      },
      {100, {}});
}

TEST(MctsPlanner, GoesAroundSomebodyWhoStandsInTheWay) {
  const Vehicle vehicle = test::field_robot();
  MctsPlanner planner(vehicle, {});
  const auto drive_by = drive(vehicle, planner, nullptr, straight_on(16.0), {Walker{{8.0, 0.1}}});
  EXPECT_TRUE(drive_by.reached);
  EXPECT_GT(drive_by.least_gap, 0.05);
  EXPECT_LT(drive_by.duration, 25.0);
}

TEST(MctsPlanner, LetsAPersonCrossOrPassesWithoutATouch) {
  const Vehicle vehicle = test::field_robot();
  for (const double from : {-9.0, -8.0, -7.0, -6.0, -5.0}) {
    MctsPlanner planner(vehicle, {});
    const auto crossing =
        drive(vehicle, planner, nullptr, straight_on(16.0), {Walker{{8.0, from}, {0.0, 1.2}}});
    EXPECT_TRUE(crossing.reached) << from;
    EXPECT_GT(crossing.least_gap, 0.0) << from;
  }
}

TEST(MctsPlanner, EvadesSomebodyWhoComesTowardsIt) {
  for (const Vehicle& vehicle : {test::field_robot(), test::rover()}) {
    MctsPlanner planner(vehicle, {});
    const auto meeting =
        drive(vehicle, planner, nullptr, straight_on(16.0), {Walker{{16.0, 0.0}, {-1.2, 0.0}}});
    EXPECT_TRUE(meeting.reached) << vehicle.name;
    EXPECT_GT(meeting.least_gap, 0.0) << vehicle.name;
  }
}

TEST(MctsPlanner, ReachesAPlaceInsideItsTurningCircle) {
  Vehicle vehicle = test::field_robot();
  for (const bool reverse : {false, true}) {
    vehicle.can_reverse = reverse;
    MctsPlanner planner(vehicle, {});
    LocalGoal beside = straight_on(0.0, 0.5);
    beside.place = {0.0, 1.2};
    const auto loop = drive(vehicle, planner, nullptr, beside, {});
    EXPECT_TRUE(loop.reached) << reverse;
    EXPECT_LT(loop.driven, 15.0) << reverse;
  }
}

TEST(MctsPlanner, LeavesADeadEndBackwards) {
  const Vehicle vehicle = test::field_robot();
  // Three walls around the front; the place lies behind.
  const ClearanceMap walls =
      ClearanceMap::of({test::box(4.0, -3.0, 4.5, 3.0), test::box(-1.0, 2.5, 4.5, 3.0),
                        test::box(-1.0, -3.0, 4.5, -2.5)});
  MctsPlanner planner(vehicle, {});
  LocalGoal behind = straight_on(-9.0, 1.0);
  const auto out = drive(vehicle, planner, nullptr, behind, {}, &walls);
  EXPECT_TRUE(out.reached);
}

TEST(MctsPlanner, BrakesWhereNothingElseIsLeft) {
  const Vehicle vehicle = test::field_robot();
  MctsPlanner planner(vehicle, {});
  const ClearanceMap wall = ClearanceMap::of({test::box(3.7, -30.0, 4.5, 30.0)});
  LocalScene scene;
  scene.robot.state.speed = 1.0;
  scene.map = &wall;
  LocalPlan plan;
  planner.plan(scene, straight_on(20.0), {200, {}}, plan);
  EXPECT_LT(plan.states.back().pose.x, 3.7 - vehicle.footprint.front_m);
}

TEST(MctsPlanner, BrakesWhereEvenBrakingIsTooLate) {
  const Vehicle vehicle = test::field_robot();
  LocalScene scene;
  scene.robot.state.speed = 1.0;
  scene.robot.state.pose.yaw = deg_to_rad(15.0);
  const double ahead = 0.5 * (vehicle.footprint.front_m - vehicle.footprint.rear_m);
  const Point2 centre = scene.robot.state.pose * Point2(ahead, 0.0);
  LocalPlan plan;
  for (int i = 0; i < 60; ++i) {
    const Point2 near = centre + (0.9 + 0.02 * i) * Point2(1.0, 1.0);
    for (const Polygon& wall : {test::box(near.x(), -30.0, near.x() + 1.0, 30.0),
                                test::box(-30.0, near.y(), 30.0, near.y() + 1.0)}) {
      const ClearanceMap map = ClearanceMap::of({wall});
      scene.map = &map;
      MctsPlanner(vehicle, {}).plan(scene, straight_on(20.0), {200, {}}, plan);
      EXPECT_TRUE(test::is_drivable(vehicle, scene, plan)) << near.transpose();
    }
  }
}

TEST(MctsPlanner, ItsPatienceBeginsAnewAfterAPause) {
  const Vehicle vehicle = test::field_robot();
  const std::vector<Agent> agents{test::agent_at(5.0, 0.4), test::agent_at(5.5, -2.0)};
  LocalScene scene;
  scene.agents = agents;
  const auto plan_at = [&](MctsPlanner& planner, double time) {
    scene.time_s = time;
    LocalPlan plan;
    planner.plan(scene, straight_on(16.0), {300, {}}, plan);
    return plan;
  };
  MctsPlanner planner(vehicle, {});
  plan_at(planner, 0.0);
  MctsPlanner fresh(vehicle, {});
  const LocalPlan paused = plan_at(planner, 300.0);
  const LocalPlan anew = plan_at(fresh, 300.0);
  EXPECT_EQ(paused.cost, anew.cost);
  EXPECT_TRUE(same_states(paused, anew));
  const LocalPlan backwards = plan_at(planner, 100.0);
  EXPECT_EQ(backwards.cost, anew.cost) << "time went back";
  MctsPlanner waiting(vehicle, {});
  for (int i = 0; i < 30; ++i) plan_at(waiting, 0.5 * i);
  EXPECT_NE(plan_at(waiting, 15.0).cost, anew.cost) << "it has been waiting";
}

// Seen where he was half a second ago, somebody is where his velocity has brought him.
TEST(MctsPlanner, MovesAgentsOnByTheAgeOfTheScene) {
  const Vehicle vehicle = test::field_robot();
  for (const bool predicts : {false, true}) {
    const auto plan_for = [&](const Point2& position, double age) {
      MctsPlanner planner(vehicle, {},
                          predicts ? std::make_unique<ConstantVelocityPredictor>() : nullptr);
      const std::vector<Agent> agents{test::agent_at(position.x(), position.y(), 0.0, -1.0)};
      const LocalScene scene{10.0, VehicleState{{0.0, 0.0, 0.0}, 1.0, 0.0, 0.0}, agents, nullptr,
                             age};
      planner.observe(scene);
      LocalPlan plan;
      planner.plan(scene, straight_on(16.0), {200, {}}, plan);
      return plan;
    };
    const LocalPlan old = plan_for({5.0, 1.5}, 0.5);
    const LocalPlan anew = plan_for({5.0, 1.0}, 0.0);
    EXPECT_NEAR(old.cost, anew.cost, 1e-3) << predicts;
    EXPECT_GT(std::abs(plan_for({5.0, 1.5}, 0.0).cost - anew.cost), 0.05) << predicts;
  }
}

TEST(MctsPlanner, EndsOnAClockThatStandsStill) {
  MctsConfig config;
  config.depth_count = 1;
  MctsPlanner planner(test::field_robot(), config);
  const StillClock clock;
  LocalPlan plan;
  planner.plan({}, straight_on(10.0), {0, Deadline::in(&clock, 0.05)}, plan);
  EXPECT_EQ(plan.expansions, 2000000);
}

TEST(MctsPlanner, StopsAtItsDeadline) {
  const Vehicle vehicle = test::field_robot();
  MctsPlanner planner(vehicle, {});
  const CountingClock clock;
  LocalScene scene;
  LocalPlan plan;
  planner.plan(scene, straight_on(10.0), {0, Deadline::in(&clock, 0.05)}, plan);
  EXPECT_GT(plan.expansions, 0);
  EXPECT_LT(plan.expansions, 1000);
}

TEST(MctsPlanner, PlansBetterWithMoreIterations) {
  const Vehicle vehicle = test::field_robot();
  RandomStream random(4, "budget");
  double few = 0.0;
  double many = 0.0;
  for (int i = 0; i < 20; ++i) {
    LocalScene scene;
    scene.robot.state.speed = 1.0;
    std::vector<Agent> agents = test::crowd(10, 8.0, random);
    std::erase_if(agents, [](const Agent& a) { return a.position.norm() < 3.0; });
    scene.agents = agents;
    LocalPlan plan;
    MctsPlanner hasty(vehicle, {});
    hasty.plan(scene, straight_on(12.0), {20, {}}, plan);
    few += plan.cost;
    MctsPlanner patient(vehicle, {});
    patient.plan(scene, straight_on(12.0), {2000, {}}, plan);
    many += plan.cost;
  }
  EXPECT_LT(many, few);
}

TEST(MctsPlanner, KeepsItsTreeWhileAgentsDoAsExpected) {
  const Vehicle vehicle = test::field_robot();
  const MctsConfig config;
  for (const double surprise : {0.0, 0.3}) {
    MctsPlanner planner(vehicle, config);
    std::vector<Agent> agents{test::agent_at(5.0, 3.0, 0.0, -0.5)};
    LocalScene scene;
    scene.agents = agents;
    LocalPlan plan;
    planner.plan(scene, straight_on(12.0), {300, {}}, plan);
    EXPECT_EQ(planner.kept_nodes(), 0);
    agents[0].position += Point2(surprise, -0.5 * config.step_s);
    scene.time_s = config.step_s;
    scene.robot.state = plan.at(config.step_s);
    planner.plan(scene, straight_on(12.0), {300, {}}, plan);
    EXPECT_EQ(planner.kept_nodes() > 0, surprise == 0.0);
  }
}

TEST(MctsPlanner, DrivesByTheSeedsCostToo) {
  const Vehicle vehicle = test::field_robot();
  MctsConfig config;
  config.cost = MctsCost::kSeed;
  MctsPlanner planner(vehicle, config);
  const auto meeting =
      drive(vehicle, planner, nullptr, straight_on(16.0, 2.0), {Walker{{16.0, 2.5}, {-1.0, 0.0}}});
  EXPECT_TRUE(meeting.reached);
  EXPECT_GT(meeting.least_gap, 0.0);
}

}  // namespace
}  // namespace headland
