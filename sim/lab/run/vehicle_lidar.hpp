// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/geometry/pose2.hpp"
#include "core/world/agent.hpp"
#include "sim/lidar/lidar.hpp"
#include "sim/lidar/scene.hpp"

namespace headland {

/// The lidar on a simulated vehicle, tick by tick. Deterministic for a seed.
class VehicleLidar {
 public:
  /// `period` [s]: from the end of a scan to the end of the next, at least a scan's duration.
  VehicleLidar(const SensorMount& mount, const LidarConfig& config, double period,
               const LidarScene& scene, std::uint64_t seed);

  /// The vehicle stands at `truth` at `time` [s], which grows; `agents` are about. The scan that
  /// ends now, or null; it holds until the next call. `wanted`: whether one is to begin when due.
  const LidarScan* step(double time, const Pose2& truth, std::span<const Agent> agents,
                        bool wanted);
  double duration() const { return lidar_.duration(); }  ///< of a scan [s]

 private:
  double period_;
  LidarScene scene_;
  LidarSimulator lidar_;
  LidarScan scan_;
  bool scanning_ = false;
  Pose2 began_at_;        // the scan that is under way
  double began_s_ = 0.0;  // likewise
  double due_s_ = 0.0;    // the next scan begins
};

}  // namespace headland
