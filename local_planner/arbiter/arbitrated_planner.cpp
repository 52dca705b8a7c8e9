// SPDX-License-Identifier: Apache-2.0
#include "local_planner/arbiter/arbitrated_planner.hpp"

#include <utility>

namespace headland {

ArbitratedPlanner::ArbitratedPlanner(const Vehicle& vehicle, const ArbiterConfig& config,
                                     std::unique_ptr<LocalPlanner> along,
                                     std::unique_ptr<LocalPlanner> around)
    : LocalPlanner(vehicle),
      arbiter_(vehicle, config),
      along_(std::move(along)),
      around_(std::move(around)) {}

void ArbitratedPlanner::do_observe(const LocalScene& scene) {
  along_->observe(scene);
  around_->observe(scene);
}

void ArbitratedPlanner::do_plan(const LocalScene& scene, const LocalGoal& goal,
                                const PlanBudget& budget, LocalPlan& plan) {
  const Driving driving = arbiter_.decide(scene, goal, view_);
  (driving == Driving::kPath ? along_ : around_)->plan(scene, goal, budget, plan);
}

}  // namespace headland
