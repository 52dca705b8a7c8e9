// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "local_planner/fail_safe/fail_safe.hpp"
#include "local_planner/local_planner.hpp"

namespace headland {

struct FailSafePlannerConfig {
  double horizon_s = 3.0;
  double lookahead_m = 1.0;       ///< at a stand
  double lookahead_time_s = 1.0;  ///< added per speed
  FailSafeConfig fail_safe;

  template <class V>
  void visit(V& v) {
    v("horizon_s", horizon_s, config::Range{0.5, 30.0}, "Length of a plan [s]");
    v("lookahead_m", lookahead_m, config::Range{0.1, 20.0}, "Lookahead at a stand [m]");
    v("lookahead_time_s", lookahead_time_s, config::Range{0.0, 10.0},
      "Lookahead added per speed [s]");
    v("fail_safe", fail_safe, "The layer that says how fast");
  }
};

/// Seed 003's "FS": follows the global path, as fast as the fail-safe layer lets it, and stands
/// while somebody is in the way. It evades nobody. The path is followed by pure pursuit (Coulter
/// 1992); a static obstacle on it is stopped for. About 20 us and the fail-safe's own cost.
class FailSafePlanner : public LocalPlanner {
 public:
  FailSafePlanner(const Vehicle& vehicle, const FailSafePlannerConfig& config = {});

 protected:
  void do_plan(const LocalScene& scene, const LocalGoal& goal, const PlanBudget& budget,
               LocalPlan& plan) override;

 private:
  double follow(const LocalScene& scene, const LocalGoal& goal, double speed, double way,
                LocalPlan& plan) const;

  FailSafePlannerConfig config_;
  FailSafe fail_safe_;
  OutlineDiscs discs_;
  LocalPlan scratch_;
};

}  // namespace headland
