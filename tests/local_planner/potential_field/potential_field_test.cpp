// SPDX-License-Identifier: Apache-2.0
#include "local_planner/potential_field/potential_field.hpp"

#include <gtest/gtest.h>

#include "tests/local_planner/episode.hpp"
#include "tests/local_planner/planner_laws.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland::test {
namespace {

PotentialFieldConfig of_form(PotentialForm form) {
  PotentialFieldConfig config;
  config.form = form;
  return config;
}
constexpr PotentialForm kForms[] = {PotentialForm::kSeed, PotentialForm::kVelocity};

TEST(PotentialField, KeepsTheLawsOfPlanners) {
  expect_planner_laws(
      [](const Vehicle& vehicle) { return std::make_unique<PotentialField>(vehicle); });
  expect_plans_are_drivable(
      [](const Vehicle& vehicle) {
        return std::make_unique<PotentialField>(vehicle, of_form(PotentialForm::kSeed));
      },
      {});
}

TEST(PotentialField, WithNobodyThereItFollowsThePath) {
  const Path path = curved_path();
  for (const PotentialForm form : kForms) {
    for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
      PotentialField planner(vehicle, of_form(form));
      const LocalGoal goal{&path, 0.0, path.end_pose().position(), 0.5, 1.2};
      const Episode e = drive(vehicle, planner, nullptr, goal, {});
      EXPECT_TRUE(e.reached) << vehicle.name;
      EXPECT_LT(e.farthest_off, 0.3) << vehicle.name;
    }
  }
}

TEST(PotentialField, GoesAroundWhoStandsBesideThePath) {
  const Path path = curved_path();
  for (const PotentialForm form : kForms) {
    for (const Vehicle& vehicle : {field_robot(), tractor(), rover()}) {
      PotentialField planner(vehicle, of_form(form));
      const LocalGoal goal{&path, 0.0, {15.0, 0.0}, 0.5, 1.2};
      const Episode e = drive(vehicle, planner, nullptr, goal, {{{8.0, 0.9}, {0.0, 0.0}}});
      EXPECT_TRUE(e.reached) << vehicle.name << ", form " << static_cast<int>(form);
      EXPECT_GT(e.least_gap, 0.0) << vehicle.name << ", form " << static_cast<int>(form);
    }
  }
}

TEST(Repulsion, IsTheSlopeOfTheSeedsField) {
  const SeedRepulsion field;
  const double far = 6.0;
  const auto potential = [&](double x) {  // the agent's border at 0, the goal behind it
    const double sum = field.strength_ratio / (1.0 + std::pow(-x / field.width_m, 6.0));
    return (1.0 + sum) * (far - x) * (far - x);
  };
  for (const double gap : {0.4, 0.8, 1.2, 2.0}) {
    const PotentialSource source{gap, {1.0, 0.0}, {0.0, 0.0}};
    const double distance = far + gap;
    const Point2 push = field.push({&source, 1}, distance, 0.0, {1.0, 0.0});
    const double sum = field.strength_ratio / (1.0 + std::pow(gap / field.width_m, 6.0));
    const double slope = (potential(-gap + 1e-5) - potential(-gap - 1e-5)) / 2e-5;
    EXPECT_NEAR(1.0 + push.x(), -slope / (2.0 * distance * (1.0 + sum)), 1e-6) << gap;
    EXPECT_EQ(push.y(), 0.0);
  }
}

TEST(Repulsion, OfGeAndCuiIsTheSlopeOverPositionAndVelocity) {
  const VelocityRepulsion field;
  const Point2 agent(3.0, 0.0);
  const double radius = 0.5 + field.margin_m;
  const auto potential = [&](const Point2& position, const Point2& velocity) {
    const Point2 off = agent - position;
    const double closing = velocity.dot(off) / off.norm();
    const double braking = 0.5 * closing * closing / field.acceleration_mps2;
    return field.strength_m / (off.norm() - radius - braking);
  };
  const Point2 velocity(1.0, 0.4);
  const PotentialSource source{agent.norm() - 0.5, {1.0, 0.0}, {0.0, 0.0}};
  const Point2 push = field.push({&source, 1}, velocity, 0.0, {1.0, 0.0});
  const double h = 1e-5;
  const Point2 x(h, 0.0);
  const double along = (potential(x, velocity) - potential(-x, velocity) +
                        potential({0.0, 0.0}, velocity + x) - potential({0.0, 0.0}, velocity - x)) /
                       (2.0 * h);
  EXPECT_NEAR(push.x(), -along, 1e-6);
  EXPECT_GT(push.y(), 0.0) << "towards the side that it passes on";
}

TEST(Repulsion, OfGeAndCuiLeavesAloneWhoMovesAway) {
  const PotentialSource source{0.5, {1.0, 0.0}, {1.5, 0.0}};
  EXPECT_EQ(VelocityRepulsion().push({&source, 1}, {1.0, 0.0}, 0.5, {1.0, 0.0}).norm(), 0.0);
}

TEST(PotentialField, KeepsItsBuffers) {
  RandomStream random(3, "buffers");
  OwnedScene owned;
  owned.agents = crowd(50, 12.0, random);
  const LocalGoal goal{nullptr, 0.0, {15.0, 0.0}, 1.0, 1.2};
  PotentialField planner(field_robot());
  LocalPlan plan;
  for (int i = 0; i < 3; ++i) planner.plan(owned.view(0.3 * i), goal, {}, plan);
  const long before = headland::testing::allocation_count();
  planner.plan(owned.view(0.9), goal, {}, plan);
  EXPECT_EQ(headland::testing::allocation_count(), before);
}

}  // namespace
}  // namespace headland::test
