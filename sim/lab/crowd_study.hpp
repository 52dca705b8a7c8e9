// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/model/vehicle.hpp"
#include "sim/lab/episodes.hpp"
#include "sim/lab/local_planners.hpp"
#include "sim/lab/study_result.hpp"

namespace headland {

/// Local planners in the "mixed" test of Eiffert et al. 2020 (sim/lab/crowd/scenario.hpp), beside
/// what they published: with people who see the robot, and with people who do not, as livestock or
/// someone who looks elsewhere would not.
struct CrowdStudyConfig {
  std::string study = "crowd";
  int seed = 1;
  int runs_count = 1000;
  int iterations_count = 500;  ///< of a decision
  std::vector<LocalPlannerKind> planners = {LocalPlannerKind::kMcts};
  Vehicle vehicle;
  LocalPlannersConfig local;

  /// No planner twice.
  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("study", study, "Which study this file is for");
    v("seed", seed, config::Range{0, 1000000000}, "Of the scenarios");
    v("runs_count", runs_count, config::Range{1, 10000000}, "Scenarios, the same for all planners");
    v("iterations_count", iterations_count, config::Range{1, 100000000},
      "Budget of a decision, for planners that search");
    v("planners", planners, "Who drives; the first is compared with each of the others");
    v("vehicle", vehicle, "Who is driven; in the test itself, a disc of 0.3 m that goes any way");
    v("local", local, "Settings of the planners");
  }
};

/// Cells `<planner>/visible` and `<planner>/invisible`, and those of `orca_holonomic`: the test's
/// own kind of robot, by which the scenarios can be held against others' figures. Metrics: success,
/// collision, robot_fault_collision (the robot drove towards the person, faster than 0.05 m/s),
/// timeout, near_miss_episodes (shares of episodes), time_s and length_m of successes,
/// gap_m (least distance to a person; gap_cvar5_m: mean of the worst twentieth), near_count (steps
/// an episode), disturbed_ratio, disturbed_half_ratio, disturbed_quarter_ratio, plan_ms (of all
/// decisions, processor time), success_P and collision_P with P = 2_4, 5_8, 9_11 people. All but
/// plan_ms is deterministic.
/// @return Errors of run_episodes.
Result<StudyResult> run_crowd_study(const CrowdStudyConfig& config, const StudyRun& run = {});

}  // namespace headland
