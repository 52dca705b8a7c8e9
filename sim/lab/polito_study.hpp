// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "control/lookahead_rover/rover_tracker.hpp"
#include "control/lookahead_rover/seed_lookahead_rover.hpp"
#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "sim/lab/polito/orchard.hpp"
#include "sim/lab/study_result.hpp"

namespace headland {

/// The study of seed 004: its follower reproduced, ours beside it on the same plant, path, speed
/// and position errors. The defaults are its best case (Fig. 20, Tables 1-3).
struct PolitoStudyConfig {
  std::string study = "polito";
  int seed = 1;
  int runs_count = 20;             ///< drives behind each cell with position errors
  double cycle_s = 0.05;           ///< t; (004) gives no value, this one reproduces its RA
  double speed_kmh = 7.0;          ///< of both followers; (004) Table 1
  double acceleration_mps2 = 1.0;  ///< ours starts from standstill; the seed's rover is at speed
  double waypoint_pitch_m = 0.33;  ///< WPP
  double steering_threshold_deg = 2.5;                         ///< (004) Table 3
  std::vector<double> accuracies_m = {0.01, 0.02, 0.05, 0.1};  ///< (004) Tables 2 and 3
  std::vector<double> grid_lookahead_m = {0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0};  // Figs. 15-18
  std::vector<double> grid_waypoint_pitch_m = {0.16, 0.33, 0.66, 0.99, 1.32, 1.65};
  std::vector<double> cycles_s = {0.005, 0.01, 0.02, 0.04, 0.05, 0.1};
  double odometry_scale_ratio = 1.01;  ///< of the cells with a wrong wheel radius
  double heading_error_deg = 0.5;      ///< of the cells with a misaligned compass
  ParametricOrchardConfig orchard;
  double lookahead_m = 0.75;  ///< LD
  RoverTrackerConfig tracker;

  template <class V>
  void visit(V& v) {
    v("study", study, "Which study this file is for");
    v("seed", seed, config::Range{0, 1000000000}, "Of the position errors");
    v("runs_count", runs_count, config::Range{1, 100000}, "Drives per cell with position errors");
    v("cycle_s", cycle_s, config::Range{0.001, 1.0}, "Cycle time of both followers [s]");
    v("speed_kmh", speed_kmh, config::Range{0.1, 30.0}, "Of both followers [km/h]");
    v("acceleration_mps2", acceleration_mps2, config::kPositive, "Of our rover [m/s2]");
    v("waypoint_pitch_m", waypoint_pitch_m, config::kPositive, "WPP of the baseline [m]");
    v("steering_threshold_deg", steering_threshold_deg, config::Range{0.0, 90.0},
      "Of the seed's cells with a threshold [deg]");
    v("accuracies_m", accuracies_m, config::kNonNegative, "Accuracies of the position fix [m]");
    v("grid_lookahead_m", grid_lookahead_m, config::kPositive, "LD of the grid [m]");
    v("grid_waypoint_pitch_m", grid_waypoint_pitch_m, config::kPositive, "WPP of the grid [m]");
    v("cycles_s", cycles_s, config::Range{0.001, 1.0}, "Cycle times of the cycle cells [s]");
    v("odometry_scale_ratio", odometry_scale_ratio, config::Range{0.5, 2.0},
      "Told over true speed in the cells with wrong odometry");
    v("heading_error_deg", heading_error_deg, config::Range{-10.0, 10.0},
      "Measured less true heading in the cells with a misaligned compass [deg]");
    v("orchard", orchard, "The orchard of (004) Fig. 2");
    v("lookahead_m", lookahead_m, config::kPositive, "LD of the baseline [m]");
    v("tracker", tracker, "Our tracker; its filter is told the accuracy of the cell");
  }
};

/// Cells `track/seed`, `track/ours` and theirs with `/noise_A`, `/threshold`, `/raw`,
/// `/odometry_S`, `/heading_D`, `/arc_plant`; `grid/LD_l/WPP_p`; `cycle/seed/t_T`,
/// `cycle/ours/t_T`. Metrics of each: atd_m, oscillation_count, ra_1pm by the seed's rule
/// (deviation from the waypoints' polyline, every relative peak), the same with `literal_` without
/// the floor for rounding, with `exact_` against the exact path, and `wave_` counting only peaks of
/// 1 mm and more there; max_m, samples_count, completed_ratio. `jobs` drives run at once;
/// deterministic whatever their number.
Result<StudyResult> run_polito_study(const PolitoStudyConfig& config, int jobs = 1);

}  // namespace headland
