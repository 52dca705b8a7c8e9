// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/world/lidar.hpp"
#include "perception/cloud/cloud.hpp"
#include "perception/ground/clusters.hpp"
#include "perception/ground/ground_plane.hpp"
#include "perception/ground/height_grid.hpp"
#include "perception/rows/row_detector.hpp"

namespace headland::apps {

/// How one cloud of points is looked at.
struct ScanLookConfig {
  SensorMount mount{.z_m = 0.0};
  double row_width_m = 0.0;
  CropConfig crop;
  GroundPlaneConfig ground;
  HeightGridConfig heights;
  ClusterConfig clusters;
  RowDetectorConfig rows;

  template <class V>
  void visit(V& v) {
    v("mount", mount, "The sensor on the vehicle; z_m 0: the height is found by the ground");
    v("row_width_m", row_width_m, config::Range{0.0, 20.0},
      "Between neighbouring rows [m]; 0: usual widths are tried");
    v("crop", crop, "What is looked at");
    v("ground", ground, "The ground's plane");
    v("heights", heights, "The ground cell by cell");
    v("clusters", clusters, "What stands on it");
    v("rows", rows, "The rows; row_width_m and the sensor's place are taken from above");
  }
};

/// A cluster without its points.
struct ClusterBox {
  int points_count = 0;
  Eigen::Vector3f centroid{0.0f, 0.0f, 0.0f};  ///< [m]
  Eigen::Vector3f low{0.0f, 0.0f, 0.0f};       ///< least coordinates [m]
  Eigen::Vector3f high{0.0f, 0.0f, 0.0f};      ///< greatest coordinates [m]
};

/// What a cloud shows, in `base`.
struct ScanLook {
  std::vector<LidarPoint> points;
  double sensor_height_m = 0.0;
  GroundPlane ground;
  std::vector<GroundLabel> labels;   ///< of the points
  std::vector<ClusterBox> clusters;  ///< largest first
  RowEstimate row;
  struct Timings {
    double crop_ms = 0.0;
    double ground_ms = 0.0;
    double clusters_ms = 0.0;
    double rows_ms = 0.0;  ///< of one scan
  } timings;
};

/// Ground, clusters and row of one cloud. The row is looked for as a vehicle would that stands
/// there: the cloud counts as several scans.
ScanLook look_at(const LidarScan& scan, ScanLookConfig config);

}  // namespace headland::apps
