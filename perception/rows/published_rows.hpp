// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/world/lidar.hpp"
#include "perception/rows/row_line.hpp"

namespace headland {

/// Parameters of seed 000's recipe, which gives none: these are the reference's, with which the
/// recipe was tried on real vineyard scans.
struct PublishedRowsConfig {
  double ground_inlier_m = 0.2;
  int ground_iterations_count = 100;
  double low_m = 0.4;
  double high_m = 1.8;
  double far_m = 12.0;
  double voxel_m = 0.1;
  double cluster_m = 0.5;
  double width_tolerance_m = 0.5;
  double distance_gate_m = 0.5;
  double orientation_gate_deg = 10.0;
  double forget_s = 1.0;

  template <class V>
  void visit(V& v) {
    v("ground_inlier_m", ground_inlier_m, config::kPositive, "Of the ground's plane [m]");
    v("ground_iterations_count", ground_iterations_count, config::Range{1, 10000}, "Of RANSAC");
    v("low_m", low_m, config::kNonNegative, "Least distance to the ground [m]");
    v("high_m", high_m, config::kPositive, "Largest distance to the ground [m]");
    v("far_m", far_m, config::kPositive, "Farther points are left out [m]");
    v("voxel_m", voxel_m, config::kPositive, "Down-sampling [m]");
    v("cluster_m", cluster_m, config::kPositive, "Euclidean clusters' tolerance [m]");
    v("width_tolerance_m", width_tolerance_m, config::kPositive, "Against the rows' width [m]");
    v("distance_gate_m", distance_gate_m, config::kPositive, "Against the last estimate [m]");
    v("orientation_gate_deg", orientation_gate_deg, config::kPositive,
      "Against the last estimate [deg]");
    v("forget_s", forget_s, config::kPositive, "The last estimate gates no longer than this [s]");
  }
};

/// Seed 000's crop rows as published (III-A): RANSAC for the ground plane, a band of distances
/// above it, projection onto it (Eq. 1), down-sampling, Euclidean clusters of which the two with
/// the most points are the walls, two parallel lines by least squares (Eq. 2); then gates against
/// the last estimate, left and right, and the width. The yardstick for `RowDetector`: it takes the
/// canopy for the ground, or the wrong rows for the walls, where the recipe does. No row end.
class PublishedRows {
 public:
  /// Rows are `width_m` apart [m].
  PublishedRows(const PublishedRowsConfig& config, double width_m)
      : config_(config), row_width_m_(width_m) {}

  /// The lane in one scan in `base`, `moved` (pose of this base in the last one) later; `time_s`
  /// [s] on the clock of the run. O(n log n); allocates.
  RowEstimate update(const std::vector<LidarPoint>& points_base, const Pose2& moved, double time_s);

 private:
  PublishedRowsConfig config_;
  double row_width_m_;
  std::optional<RowEstimate> last_;
  double last_time_s_ = 0.0;
};

}  // namespace headland
