// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "control/receding_horizon/horizon_problem.hpp"
#include "core/base/random.hpp"
#include "core/geometry/angle.hpp"

namespace headland::testing {

inline Slip random_slip(RandomStream& random) {
  return {random.uniform(-0.1, 0.3), random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.05)};
}

/// A reference of random curvature and speed, forward or reverse, and a vehicle somewhat off it;
/// limits that bind now and then. 15 intervals of 0.2 s.
inline HorizonProblem random_problem(RandomStream& random) {
  const bool ackermann = random.uniform(0.0, 1.0) < 0.6;
  HorizonProblem problem(
      MotionModel(ackermann ? Steering::kAckermann : Steering::kDifferential, 1.5), 15, 0.2);
  problem.slip = random_slip(random);
  const double direction = random.uniform(0.0, 1.0) < 0.7 ? 1.0 : -1.0;
  const double speed = direction * random.uniform(0.4, 2.5);
  double curvature = random.uniform(-0.3, 0.3);
  const double bend = random.uniform(-0.15, 0.15);  // of curvature per metre
  HorizonState wanted;
  wanted << random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0), random.uniform(-kPi, kPi),
      speed, 0.0;
  const double most_turn = ackermann ? deg_to_rad(40.0) : 1.0;
  for (HorizonStage& stage : problem.stages) {
    wanted(kWheelTurn) = problem.model.turn_for(curvature, speed, problem.slip);
    stage.wanted = wanted;
    stage.speed = {std::min(0.0, 1.2 * speed), std::max(0.0, 1.2 * speed)};
    stage.turn = {-most_turn, most_turn};
    const double step = speed * (1.0 - problem.slip.loss_ratio) * problem.interval_s;
    const double course = wanted(kYaw) + problem.slip.side_rad + 0.5 * curvature * step;
    wanted(kX) += step * std::cos(course);
    wanted(kY) += step * std::sin(course);
    wanted(kYaw) += curvature * step;
    curvature = std::clamp(curvature + bend * step, -0.4, 0.4);
  }
  problem.acceleration = {-1.0, 1.0};
  problem.turn_rate = {-0.6, 0.6};
  problem.start = problem.stages[0].wanted;
  problem.start(kX) += random.uniform(-0.3, 0.3);
  problem.start(kY) += random.uniform(-0.3, 0.3);
  problem.start(kYaw) += random.uniform(-0.2, 0.2);
  problem.start(kWheelSpeed) *= random.uniform(0.6, 1.0);
  problem.start(kWheelTurn) =
      std::clamp(problem.start(kWheelTurn) + random.uniform(-0.1, 0.1), -most_turn, most_turn);
  return problem;
}

/// The reference itself as a guess.
inline HorizonPlan guess_of(const HorizonProblem& problem) {
  HorizonPlan plan(problem.intervals());
  for (int k = 0; k <= problem.intervals(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    plan.states[i] = problem.stage(k).wanted;
    if (k < problem.intervals()) plan.controls[i] = problem.stage(k).control;
  }
  plan.states[0] = problem.start;
  return plan;
}

}  // namespace headland::testing
