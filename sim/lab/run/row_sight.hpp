// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/geometry/path.hpp"
#include "core/model/kinematics.hpp"
#include "perception/cloud/cloud.hpp"
#include "perception/rows/row_detector.hpp"
#include "sim/lidar/lidar.hpp"
#include "sim/lidar/scene.hpp"

namespace headland {

/// What grows along the rows.
enum class Crop : std::int8_t { kOrchardBare, kOrchardLeaf, kVineyardBare, kVineyardLeaf };

OrchardConfig plants_of(Crop crop);

/// A vehicle's lidar, and what its rows are driven by.
struct PerceptionConfig {
  bool enabled = false;
  Crop crop = Crop::kOrchardLeaf;
  double period_s = 0.2;
  SensorMount mount{.x_m = 0.5, .z_m = 1.5};
  LidarConfig lidar;
  CropConfig view{.far_m = 25.0, .high_m = 4.0};
  RowDetectorConfig rows;

  template <class V>
  void visit(V& v) {
    v("enabled", enabled, "Rows are driven by what the lidar sees, not by the map");
    v("crop", crop, "What grows: orchard_bare, orchard_leaf, vineyard_bare, vineyard_leaf");
    v("period_s", period_s, config::Range{0.1, 5.0}, "Between scans that are looked at [s]");
    v("mount", mount, "Where the lidar sits");
    v("lidar", lidar, "The lidar");
    v("view", view, "Which points are looked at");
    v("rows", rows, "How rows are found; row_width_m is the parcel's, sensor_* are the mount's");
  }
};

/// How well rows were seen.
struct RowSightMetrics {
  int scans = 0;           ///< in rows
  int valid = 0;           ///< ... that told the row
  double error_m = 0.0;    ///< sum of |perceived less true| distance from the row's middle
  double largest_m = 0.0;  ///< ... the largest
  double blind_m = 0.0;    ///< longest way in a row without it

  void add(const RowSightMetrics& other);
  double valid_ratio() const { return scans > 0 ? static_cast<double>(valid) / scans : 1.0; }
  double mae_m() const { return valid > 0 ? error_m / valid : 0.0; }
};

/// In rows a vehicle knows how far it is from their middle, and how it is turned to them, by its
/// lidar alone (seed 000, III-A and III-D: in-row navigation); how far along them, and all else
/// elsewhere, by its other sensors. Between scans the last sight is moved on by odometry.
/// Deterministic for a seed.
class RowSight {
 public:
  RowSight(const Vehicle& vehicle, const PerceptionConfig& config, const LidarScene& scene,
           std::uint64_t seed, double cycle);

  /// A new row, its neighbours `width` [m] apart; 0: no row any more.
  void begin_row(double width);
  /// One tick. `known` is what the vehicle knows by its other sensors; in a row that it sees, its
  /// place across `path` near `s` [m], and its heading, become what it sees.
  void step(double time, const VehicleState& truth, const Path& path, double s,
            VehicleEstimate& known);

  const RowSightMetrics& metrics() const { return metrics_; }

 private:
  void look(double time, const VehicleState& truth, const VehicleState& known);
  void score(const VehicleState& truth, const Path& path, double s);
  Pose2 moved_in(const VehicleState& known, double duration) const;

  Vehicle vehicle_;
  PerceptionConfig config_;
  LidarScene scene_;
  LidarSimulator lidar_;
  double cycle_;
  std::optional<RowDetector> detector_;  // none outside rows
  RowEstimate row_;
  Pose2 since_;           // this base in that of the last scan
  double due_s_ = 0.0;    // the next scan ends
  double blind_m_ = 0.0;  // driven since the row was told
  Pose2 scan_begin_;      // where the scan that is under way began
  bool is_scanning_ = false;
  LidarScan scan_;
  std::vector<LidarPoint> points_;
  RowSightMetrics metrics_;
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::Crop> {
  static constexpr std::pair<headland::Crop, std::string_view> values[] = {
      {headland::Crop::kOrchardBare, "orchard_bare"},
      {headland::Crop::kOrchardLeaf, "orchard_leaf"},
      {headland::Crop::kVineyardBare, "vineyard_bare"},
      {headland::Crop::kVineyardLeaf, "vineyard_leaf"}};
};
