// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/pure_pursuit/pure_pursuit.hpp"
#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "sim/lab/ebs221/field.hpp"
#include "sim/lab/study_result.hpp"

namespace headland {

/// What seed 002 sets for one of its drives.
struct Ebs221Part {
  std::vector<int> rows;               ///< counted from 1, in the order of work
  double planned_steering_deg = 60.0;  ///< of the turns
  double max_steering_deg = 60.0;      ///< of the vehicle
  double lookahead_line_m = 1.0;
  double lookahead_turn_m = 0.8;

  template <class V>
  void visit(V& v) {
    v("rows", rows, config::Range{1, 16}, "Order of work, counted from 1; the first from its top");
    v("planned_steering_deg", planned_steering_deg, config::Range{1.0, 80.0},
      "Steering angle of the planned turns [deg]");
    v("max_steering_deg", max_steering_deg, config::Range{1.0, 80.0}, "Steering limit [deg]");
    v("lookahead_line_m", lookahead_line_m, config::kPositive, "Ld in rows [m]");
    v("lookahead_turn_m", lookahead_turn_m, config::kPositive, "Ld in headland turns [m]");
  }
};

/// The study of seed 002: its row orders, its drives of parts D, E and F and its fishtail run
/// reproduced; the true optima and our tracker beside them. The defaults are its values.
struct Ebs221StudyConfig {
  std::string study = "ebs221";
  int seed = 1;
  int runs_count = 20;               ///< drives of part E with waypoints off by a rounding error
  double waypoint_error_m = 1e-12;   ///< of those drives
  double wheelbase_m = 2.5;          ///< of all drives; plans have field.planning_wheelbase_m
  double speed_mps = 1.0;            ///< of all drives
  double period_s = 0.01;            ///< of all controllers
  double steering_rate_radps = 2.0;  ///< of ours; the seed's steering is immediate
  double acceleration_mps2 = 1.0;    ///< of ours; the seed's vehicle is at speed
  Ebs221Field field;
  Ebs221Part part_d{{1, 3, 5, 7, 9, 10, 8, 6, 4, 2}, 60.0, 60.0, 1.0, 0.8};
  Ebs221Part part_e{{1, 3, 5, 7, 9, 10, 8, 6, 4, 2}, 60.0, 30.0, 4.0, 2.0};
  Ebs221Part part_f{{1, 6, 7, 5, 10, 4, 9, 3, 8, 2}, 30.0, 30.0, 1.0, 0.2};
  Ebs221Part part_fishtail{{1, 3, 5, 7, 9, 10, 8, 6, 4, 2}, 60.0, 60.0, 1.0, 0.5};
  PurePursuitConfig tracker;

  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("study", study, "Which study this file is for");
    v("seed", seed, config::Range{0, 1000000000}, "Of the waypoints' errors in part E");
    v("runs_count", runs_count, config::Range{1, 100000},
      "Drives of part E with waypoints off by waypoint_error_m");
    v("waypoint_error_m", waypoint_error_m, config::kNonNegative,
      "Half width of those waypoints' uniform error [m]");
    v("wheelbase_m", wheelbase_m, config::kPositive, "Of the vehicle in all drives [m]");
    v("speed_mps", speed_mps, config::kPositive, "Of all drives [m/s]");
    v("period_s", period_s, config::Range{0.001, 0.2}, "Of all controllers [s]");
    v("steering_rate_radps", steering_rate_radps, config::kPositive,
      "Of the vehicle that ours drives; the seed's steers without delay [rad/s]");
    v("acceleration_mps2", acceleration_mps2, config::kPositive,
      "Of the vehicle that ours drives; the seed's is always at speed [m/s2]");
    v("field", field, "The field of (002) part A");
    v("part_d", part_d, "Row order and turns for 60 degrees");
    v("part_e", part_e, "Part D's drive with less steering than it was planned for");
    v("part_f", part_f, "Row order and turns for 30 degrees");
    v("part_fishtail", part_fishtail, "Part D's order with fishtails where (002) has them");
    v("tracker", tracker, "Ours");
  }
};

/// Cells `tour/seed/60deg`, `tour/seed/30deg`, `tour/true/60deg`, `tour/true/30deg`: cost_m,
/// planning_s, optimal. Cells `track/seed/D`, `E`, `F`, `fishtail`, `E/perturbed`, `track/ours/D`,
/// `F`, `fishtail`, `fishtail_30deg`: overall_rms_m, row_rms_m, turn_rms_m, max_m (the seed's: by
/// its own rule; ours: to the exact path), the same with `true_` (to the exact path; not of the
/// seed's fishtails, which follow none) and `seed_` (by the seed's rule; not of our fishtails,
/// whose waypoints it would not know), wrong_gear_count, mean_speed_mps, guided_count,
/// completed_ratio; `track/seed/fishtail` also forward_rms_m, reverse_rms_m, reverse_count. All but
/// planning_s is deterministic.
Result<StudyResult> run_ebs221_study(const Ebs221StudyConfig& config);

}  // namespace headland
