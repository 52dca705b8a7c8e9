// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "control/tracker.hpp"
#include "core/config/visit.hpp"
#include "core/model/drive_cost.hpp"

namespace headland {

/// The way that the tracking study drives: row, U-turn to the left, row, fishtail to the right,
/// row.
struct TrackingCourseConfig {
  double row_m = 20.0;
  double turn_radius_m = 3.0;
  double clothoid_m = 1.5;
  double fishtail_radius_m = 2.0;
  double fishtail_apart_m = 2.5;
  double fishtail_speed_mps = 0.8;

  template <class V>
  void visit(V& v) {
    v("row_m", row_m, config::Range{5.0, 1000.0}, "Length of a row [m]");
    v("turn_radius_m", turn_radius_m, config::Range{0.5, 100.0}, "Of the U-turn's arc [m]");
    v("clothoid_m", clothoid_m, config::Range{0.0, 50.0},
      "Length of the U-turn's transition curves [m]; 0: its curvature steps");
    v("fishtail_radius_m", fishtail_radius_m, config::Range{0.5, 100.0},
      "Of the fishtail's quarter circles [m]");
    v("fishtail_apart_m", fishtail_apart_m, config::Range{0.1, 100.0},
      "Between the rows that the fishtail joins [m]");
    v("fishtail_speed_mps", fishtail_speed_mps, config::kPositive,
      "Fastest in the fishtail, whatever the speed elsewhere [m/s]");
  }
};

struct TrackingCourse {
  Reference reference;
  std::vector<LegKind> kinds;   ///< of the legs
  int fishtail_leg = -1;        ///< none: -1
  double mid_turn_s = 0.0;      ///< the middle of the U-turn [m]
  std::vector<double> cusps_s;  ///< [m]
};

/// Rows and U-turn at `speed` [m/s]. `fishtail` false: without it and the row behind it, for
/// followers that know no reverse gear.
TrackingCourse tracking_course(const TrackingCourseConfig& config, double speed, bool fishtail);

}  // namespace headland
