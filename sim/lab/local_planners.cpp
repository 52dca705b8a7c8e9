// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/local_planners.hpp"

namespace headland {
namespace {

std::unique_ptr<Predictor> make_predictor(const LocalPlannersConfig& config) {
  switch (config.predictor) {
    case PredictorKind::kConstantVelocity:
      return std::make_unique<ConstantVelocityPredictor>(config.constant_velocity);
    case PredictorKind::kHerd:
      return std::make_unique<HerdPredictor>(config.herd);
    case PredictorKind::kOrca:
      break;
  }
  return std::make_unique<OrcaPredictor>(config.orca);
}

}  // namespace

std::unique_ptr<LocalPlanner> make_local_planner(LocalPlannerKind kind,
                                                 const LocalPlannersConfig& config,
                                                 const Vehicle& vehicle) {
  switch (kind) {
    case LocalPlannerKind::kPotentialField:
      return std::make_unique<PotentialField>(vehicle, config.potential_field);
    case LocalPlannerKind::kOrca:
      return std::make_unique<VelocityObstacle>(vehicle, config.velocity_obstacle);
    case LocalPlannerKind::kFailSafe:
      return std::make_unique<FailSafePlanner>(vehicle, config.fs);
    case LocalPlannerKind::kMcts:
      break;
  }
  return std::make_unique<MctsPlanner>(vehicle, config.mcts, make_predictor(config));
}

}  // namespace headland
