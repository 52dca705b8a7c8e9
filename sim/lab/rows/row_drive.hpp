// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/config/visit.hpp"
#include "perception/rows/row_detector.hpp"
#include "sim/lidar/lidar.hpp"
#include "sim/lidar/orchard.hpp"
#include "sim/lidar/scene.hpp"

namespace headland {

/// How a robot goes through the middle lane of straight rows, and what its odometry is worth.
struct RowDriveConfig {
  double step_m = 0.3;
  double speed_mps = 1.5;
  double approach_m = 6.0;
  double leave_m = 5.0;
  double wander_m = 0.3;
  double wander_deg = 5.0;
  double lookahead_m = 3.0;
  double scale_ratio = 0.005;
  double turn_noise_deg = 0.03;

  template <class V>
  void visit(V& v) {
    v("step_m", step_m, config::Range{0.05, 5.0}, "From scan to scan [m]");
    v("speed_mps", speed_mps, config::Range{0.1, 10.0}, "[m/s]");
    v("approach_m", approach_m, config::kNonNegative, "Starts so far ahead of the rows [m]");
    v("leave_m", leave_m, config::kNonNegative, "and goes on so far behind them [m]");
    v("wander_m", wander_m, config::Range{0.0, 2.0}, "To either side of the lane's centre [m]");
    v("wander_deg", wander_deg, config::Range{0.0, 30.0}, "at most so far off its heading [deg]");
    v("lookahead_m", lookahead_m, config::kPositive, "Of the follower in the closed loop [m]");
    v("scale_ratio", scale_ratio, config::Range{-0.2, 0.2}, "Odometry says so much more way");
    v("turn_noise_deg", turn_noise_deg, config::kNonNegative, "Its error per step [deg]");
  }
};

/// What a detector said along one drive.
struct RowDrive {
  std::vector<double> way_m;          ///< of the scans within the rows with a valid lane
  std::vector<double> errors_m;       ///< of the centre line at the robot, at these
  std::vector<double> headings_rad;   ///< errors
  int lane_scans = 0;                 ///< within the rows
  int headland_scans = 0;             ///< outside of them
  int false_lanes = 0;                ///< valid out there
  double end_first_m = 0.0;           ///< where the rows' end was first seen, ahead; 0: never
  std::vector<double> end_errors_m;   ///< of its distance, over the last 8 m
  std::vector<double> differences_m;  ///< closed loop: distance to the left less to the right side
  double driven_ratio = 0.0;          ///< closed loop: share of the rows driven
  std::vector<double> scan_ms;        ///< processor time of an update
};

/// Drives with a given wander through the rows, from the headland to the headland, the detectors
/// looking at the same scans. Deterministic for a seed, but for scan_ms.
std::vector<RowDrive> wander_through(const LidarScene& scene, const RowLayout& layout,
                                     const LidarConfig& lidar, const SensorMount& mount,
                                     const RowDriveConfig& drive,
                                     const std::vector<RowDetectorConfig>& detectors,
                                     std::uint64_t seed);

/// Closed loop from the rows' begin to their end: pure pursuit of the centre line as detected;
/// straight on without one. Ends early where the robot leaves its lane.
RowDrive follow_lane(const LidarScene& scene, const RowLayout& layout, const LidarConfig& lidar,
                     const SensorMount& mount, const RowDriveConfig& drive,
                     const RowDetectorConfig& detector, std::uint64_t seed);

}  // namespace headland
