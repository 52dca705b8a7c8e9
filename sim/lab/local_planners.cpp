// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/local_planners.hpp"

namespace headland {
std::unique_ptr<LocalPlanner> make_local_planner(LocalPlannerKind kind,
                                                 const LocalPlannersConfig& config,
                                                 const Vehicle& vehicle,
                                                 const PredictorFactory& predictor) {
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
  return std::make_unique<MctsPlanner>(vehicle, config.mcts, predictor());
}

}  // namespace headland
