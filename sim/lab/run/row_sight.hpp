// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/path.hpp"
#include "core/model/kinematics.hpp"
#include "sim/lab/run/perception_config.hpp"

namespace headland {

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
/// Deterministic.
class RowSight {
 public:
  /// The vehicle has a lidar. `cycle` [s]: between two ticks.
  RowSight(const Vehicle& vehicle, const PerceptionConfig& config, double cycle);

  /// A new row, its neighbours `width` [m] apart; 0: no row any more.
  void begin_row(double width);
  bool in_row() const { return detector_.has_value(); }
  /// One tick. `scan` ended now, null: none did. `known` is what the vehicle knows by its other
  /// sensors; in a row that it sees, its place across `path` near `s` [m], and its heading, become
  /// what it sees. `truth`: for the metrics alone.
  void step(double time, const LidarScan* scan, const Pose2& truth, const Path& path, double s,
            VehicleEstimate& known);

  const RowSightMetrics& metrics() const { return metrics_; }

 private:
  void look(double time, const LidarScan& scan, const VehicleState& known);
  void score(const Pose2& truth, const Path& path, double s);

  Vehicle vehicle_;
  PerceptionConfig config_;
  double cycle_;
  std::optional<RowDetector> detector_;  // none outside rows
  RowEstimate row_;
  Pose2 since_;           // this base in that of the last scan
  double blind_m_ = 0.0;  // driven since the row was told
  std::vector<LidarPoint> points_;
  RowSightMetrics metrics_;
};

}  // namespace headland
