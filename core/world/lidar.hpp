// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/model/sensor_mount.hpp"

namespace headland {

/// One return of a lidar.
struct LidarPoint {
  Eigen::Vector3f position{0.0f, 0.0f, 0.0f};  ///< in the frame that the cloud is in [m]
  float intensity = 0.0f;                      ///< 0 (dark) to 1 (retro-reflecting)
  float offset_s = 0.0f;                       ///< when it was shot, after the scan's time [s]
  std::uint16_t ring = 0;                      ///< laser, from the lowest up
};

/// One revolution, or any cloud of points. A beam without a return has no point.
struct LidarScan {
  double time_s = 0.0;  ///< of the first shot, on the clock of the run
  std::vector<LidarPoint> points;
};

/// One reading of an inertial measurement unit, in its own frame.
struct ImuReading {
  double time_s = 0.0;
  Eigen::Vector3d angular_rate{0.0, 0.0, 0.0};    ///< [rad/s]
  Eigen::Vector3d specific_force{0.0, 0.0, 0.0};  ///< [m/s2]; at rest and level: (0, 0, +9.81)
};

}  // namespace headland
