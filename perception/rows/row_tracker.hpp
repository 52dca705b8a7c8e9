// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/pose2.hpp"
#include "perception/rows/lane_refine.hpp"
#include "perception/rows/row_line.hpp"

namespace headland {

struct RowTrackerConfig {
  double offset_walk_m = 0.02;
  double heading_walk_deg = 0.3;
  double width_walk_m = 0.01;
  double repeat_factor = 10.0;
  double jump_deviations_count = 4.0;
  double coast_s = 1.0;
  double coast_m = 2.0;
  int confirm_count = 2;
  int renew_count = 5;

  template <class V>
  void visit(V& v) {
    v("offset_walk_m", offset_walk_m, config::kPositive,
      "How far odometry and the rows wander over one metre, across [m]");
    v("heading_walk_deg", heading_walk_deg, config::kPositive, "The same for the heading [deg]");
    v("width_walk_m", width_walk_m, config::kPositive, "The same for the width [m]");
    v("repeat_factor", repeat_factor, config::Range{1.0, 1000.0},
      "Scans show the same plants again and again: so much larger a fit's variance counts");
    v("jump_deviations_count", jump_deviations_count, config::kPositive,
      "A fit farther from what was expected is not believed");
    v("coast_s", coast_s, config::kPositive, "Lines are valid so long without a fit [s]");
    v("coast_m", coast_m, config::kPositive, "and so far [m]");
    v("confirm_count", confirm_count, config::Range{1, 100}, "Fits until new lines are valid");
    v("renew_count", renew_count, config::Range{1, 100},
      "Fits in a row that agree with each other but not with the lines replace them");
  }
};

/// The lane over time: a Kalman filter for (offset, heading, width) moved on by odometry. Fits that
/// jump are rejected (seed 000 filters "by distance and orientation"), unless they go on to agree
/// with each other: then the lines start anew.
class RowTracker {
 public:
  explicit RowTracker(const RowTrackerConfig& config) : config_(config) {}

  void reset();
  /// The robot has `moved` in `dt_s` [s].
  void predict(const Pose2& moved, double dt_s);
  /// Takes a fit in: kValid, kUnconfirmed or kJump.
  RowStatus correct(const LaneFit& fit);

  /// Is there a lane to go on with, valid or not?
  bool is_known() const { return is_known_; }
  /// Was it seen lately enough to go on with it?
  bool is_fresh() const;
  bool is_valid() const;
  /// The lane as filtered: the numbers, without validity, sides and end.
  const RowEstimate& lane() const { return lane_; }

 private:
  void start(const LaneFit& fit);

  RowTrackerConfig config_;
  bool is_known_ = false;
  RowEstimate lane_;
  int fits_ = 0;
  double since_fit_s_ = 0.0;
  double since_fit_m_ = 0.0;
  RowEstimate rejected_;
  int rejected_fits_ = 0;
};

}  // namespace headland
