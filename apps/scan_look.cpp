// SPDX-License-Identifier: Apache-2.0
#include "apps/scan_look.hpp"

#include <chrono>
#include <cmath>
#include <optional>

namespace headland::apps {
namespace {

// Heights above the ground at which lidars are carried [m], the usual ones first.
constexpr double kHeights[] = {1.5, 1.9, 1.1, 2.4, 0.7};
// Between neighbouring rows [m]: vineyards, then orchards.
constexpr double kWidths[] = {2.5, 3.8, 3.2, 2.0, 4.6, 5.6};
constexpr int kLooks = 4;            // of the same cloud, until rows are confirmed
constexpr double kLookPeriod = 0.1;  // [s]

class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

// Puts the sensor so high that the ground lies at zero.
void look_for_ground(const LidarScan& scan, const ScanLookConfig& config, ScanLook& look) {
  const bool is_known = config.mount.z_m > 0.0;
  SensorMount best = config.mount;
  GroundPlane found;
  for (const double height : kHeights) {
    SensorMount mount = config.mount;
    if (!is_known) mount.z_m = height;
    GroundPlaneConfig ground = config.ground;
    ground.sensor_height_m = mount.z_m;
    crop_to_base(scan.points, mount.pose(), config.crop, look.points);
    const GroundPlane plane = fit_ground_plane(look.points, ground);
    if (plane.valid && (!found.valid || plane.inlier_ratio > found.inlier_ratio)) {
      found = plane;
      best = mount;
    }
    if (is_known || plane.valid) break;
  }
  if (!is_known && best.z_m == 0.0) best.z_m = kHeights[0];
  look.ground = found;
  look.sensor_height_m = best.z_m;
  if (!is_known && found.valid) look.sensor_height_m += found.offset_m / found.normal.z();
}

std::optional<RowEstimate> look_for_row(const std::vector<LidarPoint>& points,
                                        const RowDetectorConfig& config, double& scan_ms) {
  RowDetector detector(config);
  RowEstimate row;
  for (int i = 0; i < kLooks; ++i) {
    const Stopwatch watch;
    row = detector.update(points, Pose2{}, kLookPeriod * i);
    scan_ms = watch.ms();
  }
  return row;
}

void find_clusters(const ScanLookConfig& config, ScanLook& look) {
  const Stopwatch watch;
  HeightGrid heights(config.heights);
  heights.update(look.points, {0.0, 0.0});
  look.labels.assign(heights.labels().begin(), heights.labels().end());
  ClusterFinder finder(config.clusters);
  for (const Cluster& c : finder.find(look.points, look.labels)) {
    look.clusters.push_back({static_cast<int>(c.count()), c.centroid, c.low, c.high});
  }
  look.timings.clusters_ms = watch.ms();
}

double uncertainty(const RowEstimate& row) { return row.covariance(0, 0) + row.covariance(2, 2); }

void look_for_row(const ScanLookConfig& config, ScanLook& look) {
  RowDetectorConfig rows = config.rows;
  rows.sensor_x_m = config.mount.x_m;
  rows.sensor_y_m = config.mount.y_m;
  rows.sensor_z_m = look.sensor_height_m;
  const bool is_known = config.row_width_m > 0.0;
  for (const double width : kWidths) {
    rows.row_width_m = is_known ? config.row_width_m : width;
    const auto row = look_for_row(look.points, rows, look.timings.rows_ms);
    const bool better =
        row && row->valid && (!look.row.valid || uncertainty(*row) < uncertainty(look.row));
    if (better || (width == kWidths[0] && row)) look.row = *row;
    if (is_known) break;
  }
}

}  // namespace

ScanLook look_at(const LidarScan& scan, ScanLookConfig config) {
  ScanLook look;
  const Stopwatch ground_watch;
  look_for_ground(scan, config, look);
  look.timings.ground_ms = ground_watch.ms();
  config.mount.z_m = look.sensor_height_m;
  const Stopwatch crop_watch;
  crop_to_base(scan.points, config.mount.pose(), config.crop, look.points);
  look.timings.crop_ms = crop_watch.ms();
  if (look.ground.valid) {
    config.ground.sensor_height_m = look.sensor_height_m;
    const Stopwatch again;
    look.ground = fit_ground_plane(look.points, config.ground);
    look.timings.ground_ms = again.ms();
  }
  find_clusters(config, look);
  look_for_row(config, look);
  return look;
}

}  // namespace headland::apps
