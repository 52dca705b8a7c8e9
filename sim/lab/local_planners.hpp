// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <utility>

#include "core/config/visit.hpp"
#include "core/model/vehicle.hpp"
#include "local_planner/fail_safe/fail_safe_planner.hpp"
#include "local_planner/local_planner.hpp"
#include "local_planner/mcts/mcts_planner.hpp"
#include "local_planner/potential_field/potential_field.hpp"
#include "local_planner/prediction/constant_velocity.hpp"
#include "local_planner/prediction/herd_predictor.hpp"
#include "local_planner/prediction/orca_predictor.hpp"
#include "local_planner/velocity_obstacle/velocity_obstacle.hpp"

namespace headland {

enum class LocalPlannerKind { kMcts, kPotentialField, kOrca, kFailSafe };
enum class PredictorKind { kConstantVelocity, kOrca, kHerd };

/// Settings of all local planners.
struct LocalPlannersConfig {
  MctsConfig mcts;
  PredictorKind predictor = PredictorKind::kOrca;
  ConstantVelocityConfig constant_velocity;
  OrcaConfig orca;
  HerdConfig herd;
  PotentialFieldConfig potential_field;
  VelocityObstacleConfig velocity_obstacle;
  FailSafePlannerConfig fs;

  template <class V>
  void visit(V& v) {
    v("mcts", mcts, "Monte Carlo tree search");
    v("predictor", predictor, "How the tree search expects agents to move");
    v("constant_velocity", constant_velocity, "Agents that go straight on");
    v("orca", orca, "Agents that give way to each other and to the robot");
    v("herd", herd, "Sheep and cattle");
    v("potential_field", potential_field, "Forces that attract and repel");
    v("velocity_obstacle", velocity_obstacle, "Velocities that avoid agents, reciprocally");
    v("fs", fs, "Following the path and waiting");
  }
};

std::unique_ptr<LocalPlanner> make_local_planner(LocalPlannerKind kind,
                                                 const LocalPlannersConfig& config,
                                                 const Vehicle& vehicle);

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::LocalPlannerKind> {
  static constexpr std::pair<headland::LocalPlannerKind, std::string_view> values[] = {
      {headland::LocalPlannerKind::kMcts, "mcts"},
      {headland::LocalPlannerKind::kPotentialField, "pf"},
      {headland::LocalPlannerKind::kOrca, "orca"},
      {headland::LocalPlannerKind::kFailSafe, "fs"}};
};

template <>
struct headland::config::EnumNames<headland::PredictorKind> {
  static constexpr std::pair<headland::PredictorKind, std::string_view> values[] = {
      {headland::PredictorKind::kConstantVelocity, "constant_velocity"},
      {headland::PredictorKind::kOrca, "orca"},
      {headland::PredictorKind::kHerd, "herd"}};
};
