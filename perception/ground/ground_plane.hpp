// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include "core/config/visit.hpp"
#include "core/world/lidar.hpp"

namespace headland {

/// Of the plane of the ground about the vehicle. Sources: reference values of the perpendicular
/// plane of PCL, measured on vineyard scans.
struct GroundPlaneConfig {
  double sensor_height_m = 1.5;
  double reach_m = 15.0;
  double axis_tolerance_deg = 15.0;
  double height_tolerance_m = 0.3;
  double inlier_m = 0.1;
  int iterations_count = 300;
  double cell_m = 1.0;
  double least_inlier_ratio = 0.25;
  int least_points_count = 30;
  int seed_count = 1;

  template <class V>
  void visit(V& v) {
    v("sensor_height_m", sensor_height_m, config::kPositive,
      "Of the lidar above the ground [m]; what is above half of it is not ground");
    v("reach_m", reach_m, config::kPositive, "Points farther than this are not looked at [m]");
    v("axis_tolerance_deg", axis_tolerance_deg, config::Range{0.1, 60.0},
      "Of the normal against gravity [deg]");
    v("height_tolerance_m", height_tolerance_m, config::kPositive,
      "Of the plane below base against base, which lies on the ground [m]");
    v("inlier_m", inlier_m, config::kPositive, "Points nearer to the plane lie on it [m]");
    v("iterations_count", iterations_count, config::Range{1, 100000},
      "Most planes tried; fewer where many points agree");
    v("cell_m", cell_m, config::Range{0.1, 10.0},
      "Of each square of this side the lowest point is tried first [m]");
    v("least_inlier_ratio", least_inlier_ratio, config::kFraction,
      "Of the points low enough; with fewer there is no plane");
    v("least_points_count", least_points_count, config::Range{3, 1000000},
      "On the plane; with fewer there is none");
    v("seed_count", seed_count, config::Range{0, 1e9}, "Of the random triples");
  }
};

/// normal . p + offset_m = 0 for all p of the plane.
struct GroundPlane {
  bool valid = false;
  Eigen::Vector3d normal{0.0, 0.0, 1.0};  ///< of length 1, z > 0, in base
  double offset_m = 0.0;
  double inlier_ratio = 0.0;  ///< share on the plane of the points that could be ground

  double height_above(const Eigen::Vector3d& p) const { return normal.dot(p) + offset_m; }
};

/// The plane of the ground, by random triples (RANSAC) of the lowest points of cells, whose normal
/// is near gravity and which pass near base; then by least squares on all points. Points above half
/// the sensor's height are no candidates and points clearly below a plane count against it, so that
/// neither a canopy nor a wall wins.
///
/// @param points_base Points in `base`, which lies on the ground; NaN are left out.
/// @param up_base     Against gravity, in base; of length 1.
/// @return Not valid where the points show no such plane; then the plane z = 0.
/// Deterministic. Thread-safe. O(n + iterations * sample), about 1 ms for 100 k points.
GroundPlane fit_ground_plane(std::span<const LidarPoint> points_base,
                             const GroundPlaneConfig& config = {},
                             const Eigen::Vector3d& up_base = Eigen::Vector3d::UnitZ());

}  // namespace headland
