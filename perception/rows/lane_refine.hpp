// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/config/visit.hpp"
#include "perception/rows/internal/columns.hpp"
#include "perception/rows/lane_search.hpp"

namespace headland {

struct LaneRefineConfig {
  double station_m = 0.5;
  double ahead_m = 12.0;
  double behind_m = 10.0;
  double gate_ratio = 0.25;
  double plant_m = 0.12;
  double column_m = 0.25;
  double width_deviation_m = 0.1;
  double curvature_1pm = 0.003;
  double outer_weight = 0.0;
  int passes_count = 5;

  template <class V>
  void visit(V& v) {
    v("station_m", station_m, config::Range{0.1, 5.0}, "Length of row that is averaged first [m]");
    v("ahead_m", ahead_m, config::kPositive, "Stations lie so far ahead [m]");
    v("behind_m", behind_m, config::kNonNegative, "and behind [m]");
    v("gate_ratio", gate_ratio, config::Range{0.05, 0.5},
      "Columns belong to a line within this share of the lane's width");
    v("plant_m", plant_m, config::kPositive,
      "Standard deviation of a station about its row, of however many columns [m]");
    v("column_m", column_m, config::kPositive, "Standard deviation of a column [m]");
    v("width_deviation_m", width_deviation_m, config::kPositive,
      "How well the width is known without a scan [m]");
    v("curvature_1pm", curvature_1pm, config::kPositive,
      "Standard deviation of the rows' curvature [1/m]");
    v("outer_weight", outer_weight, config::kFraction,
      "Of the rows beyond both lines against these; they show one flank only");
    v("passes_count", passes_count, config::Range{1, 50}, "Of reweighting");
  }
};

/// A lane with its uncertainty, in `base`.
struct LaneFit {
  double offset_m = 0.0;     ///< of the centre line from the robot, left positive [m]
  double heading_rad = 0.0;  ///< of the row at the robot [rad]
  double width_m = 0.0;
  double curvature_1pm = 0.0;
  /// Of (offset [m], heading [rad], width [m]).
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::array<int, 2> stations{};       ///< with columns, right and left
  std::array<int, 2> near_stations{};  ///< of these the ones up to four metres ahead
  std::array<double, 2> begins_m{};    ///< from where on, no farther behind than 1.5 m
  std::array<double, 2> support{};     ///< summed weight of their columns
  double inside = 0.0;                 ///< summed weight of the columns in the lane's middle
};

/// Least squares for two parallel lines, and the rows beyond them, at once.
///
/// Row i of i = -3, -1, +1, +3 half widths: v = offset + i width / 2 + u heading + u^2 curvature /
/// 2 for its stations (u, v) along and across; seed 000's Eq. 2 with the orthogonal distance in
/// place of y. With two rows and no curvature the heading is 1/2 atan2(2 sum Sxy, sum(Sxx - Syy)).
/// Columns are reweighted by Tukey's biweight. Stations weigh alike, however dense their columns:
/// near plants do not outvote the rest. Both sides are measured by the same statistic, the mean of
/// the columns seen in the canopy: it lies on the lane's side of the trunks, alike on either side,
/// so that the centre line keeps none of it. A side without columns leaves the width as expected.
class LaneRefine {
 public:
  explicit LaneRefine(const LaneRefineConfig& config) : config_(config) {}

  /// Improves `start`. `width_m`: expected. O(passes x columns). Keeps its memory.
  LaneFit refine(std::span<const internal::Column> columns, const LaneHypothesis& start,
                 double width_m);

 private:
  struct Station {
    double weight = 0.0;
    double u = 0.0;
    double v = 0.0;
  };
  struct Frame {
    double heading_rad = 0.0;
    double offset_m = 0.0;
    double width_m = 0.0;
    double curvature_1pm = 0.0;
  };

  void fill_stations(std::span<const internal::Column> columns, const Frame& frame,
                     double deviation);
  double deviation_of(std::span<const internal::Column> columns, const Frame& frame);
  Eigen::Matrix4d solve(Frame& frame, double width_m) const;
  LaneFit summary(std::span<const internal::Column> columns, const Frame& frame,
                  const Eigen::Matrix4d& covariance) const;

  LaneRefineConfig config_;
  std::array<std::vector<Station>, 4> stations_;  // of rows -3, -1, +1, +3 half widths
  std::vector<double> residuals_;
};

}  // namespace headland
