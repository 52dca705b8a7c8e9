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
#include "local_planner/prediction/predictors.hpp"
#include "local_planner/velocity_obstacle/velocity_obstacle.hpp"

namespace headland {

enum class LocalPlannerKind { kMcts, kPotentialField, kOrca, kFailSafe };

/// Settings of all local planners.
struct LocalPlannersConfig {
  MctsConfig mcts;
  PredictorKind predictor = PredictorKind::kOrca;
  PredictorsConfig predictors;
  PotentialFieldConfig potential_field;
  VelocityObstacleConfig velocity_obstacle;
  FailSafePlannerConfig fs;

  template <class V>
  void visit(V& v) {
    v("mcts", mcts, "Monte Carlo tree search");
    v("predictor", predictor, "How the tree search expects agents to move");
    predictors.visit(v);
    v("potential_field", potential_field, "Forces that attract and repel");
    v("velocity_obstacle", velocity_obstacle, "Velocities that avoid agents, reciprocally");
    v("fs", fs, "Following the path and waiting");
  }
};

/// The factory of the predictor that `config` names; see predictor_factory.
inline Result<PredictorFactory> predictor_factory(const LocalPlannersConfig& config,
                                                  const std::filesystem::path& folder) {
  return predictor_factory(config.predictor, config.predictors, folder);
}

std::unique_ptr<LocalPlanner> make_local_planner(LocalPlannerKind kind,
                                                 const LocalPlannersConfig& config,
                                                 const Vehicle& vehicle,
                                                 const PredictorFactory& predictor);

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::LocalPlannerKind> {
  static constexpr std::pair<headland::LocalPlannerKind, std::string_view> values[] = {
      {headland::LocalPlannerKind::kMcts, "mcts"},
      {headland::LocalPlannerKind::kPotentialField, "pf"},
      {headland::LocalPlannerKind::kOrca, "orca"},
      {headland::LocalPlannerKind::kFailSafe, "fs"}};
};
