// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/config/visit.hpp"
#include "perception/rows/internal/columns.hpp"

namespace headland {

struct LaneSearchConfig {
  double heading_span_deg = 16.0;
  double heading_step_deg = 1.0;
  double fine_step_deg = 0.25;
  double bin_m = 0.05;
  double wall_m = 0.3;
  double narrower_m = 0.9;
  double wider_m = 0.4;
  double inside_ratio = 0.5;
  double inside_weight = 2.0;
  double ahead_m = 12.0;
  double behind_m = 8.0;

  template <class V>
  void visit(V& v) {
    v("heading_span_deg", heading_span_deg, config::Range{1.0, 45.0},
      "Headings looked at, to either side of the expected one [deg]");
    v("heading_step_deg", heading_step_deg, config::Range{0.1, 5.0}, "Of the first pass [deg]");
    v("fine_step_deg", fine_step_deg, config::Range{0.01, 5.0}, "Of the second pass [deg]");
    v("bin_m", bin_m, config::Range{0.01, 0.5}, "Of the lines' distances [m]");
    v("wall_m", wall_m, config::Range{0.05, 1.0}, "Columns so near a line support it [m]");
    v("narrower_m", narrower_m, config::kPositive,
      "Lines may be nearer to each other than the rows: canopy is seen from the lane [m]");
    v("wider_m", wider_m, config::kPositive, "and farther [m]");
    v("inside_ratio", inside_ratio, config::kFraction,
      "Share of the lane's width, about its centre, that has to be empty");
    v("inside_weight", inside_weight, config::kNonNegative,
      "What a column in there costs, against one that supports a line");
    v("ahead_m", ahead_m, config::kPositive, "Columns are looked at so far ahead [m]");
    v("behind_m", behind_m, config::kNonNegative, "and behind [m]");
  }
};

/// Two lines of one heading, the robot between them, in `base`.
struct LaneHypothesis {
  double heading_rad = 0.0;
  double left_m = 0.0;   ///< perpendicular, left positive [m]
  double right_m = 0.0;  ///< [m]
  double score = 0.0;    ///< summed weights of columns
  double support_left = 0.0;
  double support_right = 0.0;
  double inside = 0.0;
};

/// Finds the lane the robot stands in: all headings and both lines at once.
///
/// For each heading the columns' weights are summed over their distance from a line through the
/// robot; with prefix sums a pair of lines costs a few additions: what supports both, less what
/// stands between them. Coarse, then fine about the best. "The two densest clusters" of seed 000
/// would take rows beyond the next lane, or two halves of one row; the lane's emptiness will not.
class LaneSearch {
 public:
  explicit LaneSearch(const LaneSearchConfig& config) : config_(config) {}

  /// The best lane about `width_m` wide with a heading near `expected_heading_rad`; nullopt where
  /// no pair of lines scores above zero. O(headings x (columns + pairs)). Keeps its memory.
  std::optional<LaneHypothesis> search(std::span<const internal::Column> columns, double width_m,
                                       double expected_heading_rad);

  /// Is this lane as wide as rows `width_m` apart may look?
  bool is_wide_enough(double seen_m, double width_m) const {
    return seen_m >= width_m - config_.narrower_m && seen_m <= width_m + config_.wider_m;
  }

 private:
  void sum_up(std::span<const internal::Column> columns, double heading_rad, double reach);
  void keep_best_pair(double heading_rad, double width_m, LaneHypothesis& best);

  LaneSearchConfig config_;
  double reach_m_ = 0.0;
  std::vector<double> below_;  // summed weight of the columns below each edge of the bins
};

}  // namespace headland
