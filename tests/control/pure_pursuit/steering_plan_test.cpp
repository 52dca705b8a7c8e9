// SPDX-License-Identifier: Apache-2.0
#include "control/pure_pursuit/steering_plan.hpp"

#include <gtest/gtest.h>

#include "control/speed_limits.hpp"
#include "tests/control/pure_pursuit/drive.hpp"

namespace headland {
namespace {

using namespace pure_pursuit_test;

Reference with_step(double curvature) {
  Reference reference;
  reference.path.append_straight({0.0, 0.0, 0.0}, 10.0, 0);
  reference.path.append({reference.path.end_pose(), curvature, 10.0, Gear::kForward, 0});
  reference.leg_speed = {1.0};
  return reference;
}

struct Planned {
  SpeedProfile speeds;
  SteeringPlan plan;
};

Planned make(const Reference& reference, const Vehicle& vehicle, const SteeringPlanConfig& config) {
  Planned made;
  made.speeds.build(reference, vehicle.acceleration_mps2, speed_zones(reference, vehicle, {}));
  made.plan.build(reference, made.speeds, vehicle, config);
  return made;
}

TEST(BoundedRamp, KeepsItsBoundsAndBeatsTheEvenRamp) {
  // A step of 0.5 1/m at 5 m, with 0.5 1/m^2: the ramp takes a metre.
  std::vector<RampCell> cells(250);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i].length = 0.04;
    cells[i].path_curvature = i < 125 ? 0.0 : 0.5;
    cells[i].rate_bound = 0.5;
  }
  BoundedRamp solver;
  RampWeights weights;
  weights.iterations = 150;
  const auto& ramp = solver.solve(cells, RampState::Zero(), false, 0.6, weights);
  double square = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_LT(std::abs(ramp[i + 1](2) - ramp[i](2)), 0.04 * 0.5 * 1.1) << i;
    EXPECT_LT(ramp[i](2), 0.6 * 1.02);
    square += 0.04 * ramp[i](0) * ramp[i](0);
  }
  // The even ramp leaves the path by c l^2 / 24 = 0.0208 m for good.
  const double even = 0.5 / 24.0;
  EXPECT_LT(square, 5.0 * even * even / 4.0);
  EXPECT_LT(std::abs(ramp.back()(0)), 0.05 * even);
}

TEST(SteeringPlan, IsThePathItselfAwayFromSteps) {
  const Vehicle vehicle = study_vehicle(60.0, 2.0);
  const Reference reference = with_step(0.4);
  const Planned made = make(reference, vehicle, {});
  for (const double s : {0.0, 3.0, 14.0, 19.9}) {
    const PlannedSteering at = made.plan.at(reference.path, s, 0);
    EXPECT_EQ(at.curvature, reference.path.at(s).curvature) << s;
    EXPECT_EQ(at.lateral, 0.0);
    EXPECT_EQ(at.heading, 0.0);
  }
}

TEST(SteeringPlan, TurnsTheWheelsNoFasterThanTheyCan) {
  for (const double rate : {0.5, 1.0, 2.0}) {
    const Vehicle vehicle = study_vehicle(60.0, rate);
    const Reference reference = rows({1, 3, 2, 5}, 3.0 / std::tan(deg_to_rad(60.0)), Turn::kDubins);
    const Planned made = make(reference, vehicle, {});
    const double ds = 0.2;  // some cells, so that a zone's border inside one does not count
    for (double s = 1.0; s + ds < reference.path.length() - 1.0; s += 0.01) {
      const double from = made.plan.at(reference.path, s, 0).curvature;
      const double to = made.plan.at(reference.path, s + ds, 0).curvature;
      const double turned = std::atan(2.5 * to) - std::atan(2.5 * from);
      double seconds = 0.0;
      for (int i = 0; i < 20; ++i) {
        seconds += 0.05 * ds / made.speeds.limit(s + (0.05 * i + 0.025) * ds, 0, 0.0);
      }
      ASSERT_LT(std::abs(turned) / seconds, rate * 1.1) << rate << " at " << s;
      ASSERT_LT(std::abs(made.plan.at(reference.path, s, 0).lateral), 0.5);
    }
  }
}

TEST(SteeringPlan, BeginsToTurnBeforeTheStepAndEndsBehindIt) {
  const Vehicle vehicle = study_vehicle(60.0, 1.0);
  const Reference reference = with_step(0.4);
  const Planned made = make(reference, vehicle, {});
  // A rate of 1 rad/s needs 0.785 s for it.
  EXPECT_GT(made.plan.at(reference.path, 9.9, 0).curvature, 0.05);
  EXPECT_LT(made.plan.at(reference.path, 10.1, 0).curvature, 0.35);
  EXPECT_NEAR(made.plan.at(reference.path, 10.0, 0).curvature, 0.17, 0.1);
}

}  // namespace
}  // namespace headland
