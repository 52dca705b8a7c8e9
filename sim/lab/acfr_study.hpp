// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/model/vehicle.hpp"
#include "sim/lab/acfr/episode.hpp"
#include "sim/lab/acfr/site.hpp"
#include "sim/lab/episodes.hpp"
#include "sim/lab/local_planners.hpp"
#include "sim/lab/study_result.hpp"

namespace headland {

/// The study of seed 003, section IV: a robot on tours of least energy among a crowd, with
/// different local planners, densities of the crowd, and accuracies of the waypoints. A run is an
/// iteration of the paper: one tour of 5 to 12 waypoints and back to the station; `tours_count` of
/// them belong to a scenario, a site of its own.
struct AcfrStudyConfig {
  std::string study = "acfr";
  int seed = 1;
  int runs_count = 24;          ///< iterations of each cell: 3 scenarios of 8 in the paper
  int tours_count = 8;          ///< iterations of a scenario
  int iterations_count = 1000;  ///< of the tree search, a decision
  std::vector<LocalPlannerKind> planners = {LocalPlannerKind::kMcts};
  double dense_m2 = 10.0;  ///< area per agent
  double sparse_m2 = 50.0;
  std::vector<double> accuracies_m = {5.0, 2.0, 1.0};
  double short_timeout_s = 60.0;
  AcfrSiteConfig site;
  AcfrWorldConfig world;
  Vehicle vehicle;
  LocalPlannersConfig local;

  /// No planner and no accuracy twice.
  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("study", study, "Which study this file is for");
    v("seed", seed, config::Range{0, 1000000000}, "Of sites, tours, agents and noise");
    v("runs_count", runs_count, config::Range{1, 1000000},
      "Iterations of each cell, the same for all planners");
    v("tours_count", tours_count, config::Range{1, 1000}, "Iterations on one site");
    v("iterations_count", iterations_count, config::Range{0, 100000000},
      "Budget of a decision, for planners that search");
    v("planners", planners, "Who drives");
    v("dense_m2", dense_m2, config::Range{2.0, 1e5}, "Area per agent where it is dense [m2]");
    v("sparse_m2", sparse_m2, config::Range{2.0, 1e5}, "... and sparse [m2]");
    v("accuracies_m", accuracies_m, config::Range{0.2, 20.0},
      "A waypoint is reached within this: observing, soil sampling, weeding [m]");
    v("short_timeout_s", short_timeout_s, config::kPositive,
      "The shorter of the two timeouts; the longer is world.timeout_s [s]");
    v("site", site, "Terrain and tours");
    v("world", world, "Agents and sensors");
    v("vehicle", vehicle, "The robot");
    v("local", local, "Settings of the planners");
  }
};

/// Cells `<planner>/<dense|sparse>/<accuracy>m` with fail_1min, fail_5min (shares of waypoints),
/// near_collision, robot_near, contact, robot_fault_contact (shares of interactions), least_m (of
/// interactions), displacement_m, speed_mps (of reached waypoints), standing_ratio,
/// longest_stand_s, plan_ms (processor time). All but plan_ms is deterministic. Tables I, II and
/// III in the paper's layout beside its figures.
/// @return Errors of check, of run_episodes and of planning the tours.
Result<StudyResult> run_acfr_study(const AcfrStudyConfig& config, const StudyRun& run = {});

}  // namespace headland
