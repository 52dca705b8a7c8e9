// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/local_planners.hpp"

#include "local_planner/prediction/constant_velocity.hpp"

namespace headland {
namespace {

std::unique_ptr<Predictor> make_predictor(const LocalPlannersConfig& config) {
  switch (config.predictor) {
    case PredictorKind::kConstantVelocity:
      return std::make_unique<ConstantVelocityPredictor>(config.constant_velocity);
    case PredictorKind::kReciprocal:
      break;
  }
  return std::make_unique<ReciprocalPredictor>(config.reciprocal);
}

}  // namespace

std::unique_ptr<LocalPlanner> make_local_planner(LocalPlannerKind kind,
                                                 const LocalPlannersConfig& config,
                                                 const Vehicle& vehicle) {
  switch (kind) {
    case LocalPlannerKind::kFailSafe:
      return std::make_unique<FailSafePlanner>(vehicle, config.fs);
    case LocalPlannerKind::kMcts:
      break;
  }
  return std::make_unique<MctsPlanner>(vehicle, config.mcts, make_predictor(config));
}

}  // namespace headland
