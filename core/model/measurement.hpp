// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace headland {

enum class MeasurementKind {
  kPosition,  ///< of base in map: x, y [m] (GNSS)
  kHeading,   ///< yaw of base in map [rad] (two antennas, magnetometer)
  kSpeed,     ///< speed of the wheels [m/s], signed (odometry)
  kTurn,      ///< Ackermann: steering angle [rad]; differential: yaw rate of the wheels [rad/s]
  kYawRate    ///< yaw rate of the vehicle [rad/s] (gyroscope)
};

/// One reading of one sensor.
struct Measurement {
  double time = 0.0;  ///< when it was true [s], on the clock of the run; it may arrive later
  MeasurementKind kind = MeasurementKind::kPosition;
  std::array<double, 2> value{};  ///< the second is used by kPosition only
  double deviation = 0.0;         ///< standard deviation of its noise, per component
};

}  // namespace headland
