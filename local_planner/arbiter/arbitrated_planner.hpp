// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "local_planner/arbiter/arbiter.hpp"
#include "local_planner/local_planner.hpp"

namespace headland {

/// Two planners and an arbiter as one planner: `along` drives while the path is free, `around` when
/// somebody is in the way. Both see every scene. The path may be left everywhere.
class ArbitratedPlanner : public LocalPlanner {
 public:
  ArbitratedPlanner(const Vehicle& vehicle, const ArbiterConfig& config,
                    std::unique_ptr<LocalPlanner> along, std::unique_ptr<LocalPlanner> around);

  const Arbiter& arbiter() const { return arbiter_; }
  /// Energy left above what the tour needs, over the battery's capacity (ArbiterView).
  void set_spare(double spare_ratio) { view_.spare_ratio = spare_ratio; }

 protected:
  void do_observe(const LocalScene& scene) override;
  void do_plan(const LocalScene& scene, const LocalGoal& goal, const PlanBudget& budget,
               LocalPlan& plan) override;

 private:
  Arbiter arbiter_;
  ArbiterView view_;
  std::unique_ptr<LocalPlanner> along_;
  std::unique_ptr<LocalPlanner> around_;
};

}  // namespace headland
