// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/local_planners.hpp"

namespace headland {

std::unique_ptr<LocalPlanner> make_local_planner(LocalPlannerKind kind,
                                                 const LocalPlannersConfig& config,
                                                 const Vehicle& vehicle) {
  switch (kind) {
    case LocalPlannerKind::kMcts:
      break;
  }
  return std::make_unique<MctsPlanner>(vehicle, config.mcts);
}

}  // namespace headland
