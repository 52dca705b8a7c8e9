// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace headland {

enum class MeasurementKind {
  kPosition,  ///< in map: x, y [m] (GNSS); of base, or of the antenna if its place is configured
  kHeading,   ///< yaw of base in map [rad] (two antennas, magnetometer)
  kSpeed,     ///< speed of the wheels [m/s], signed (odometry)
  kTurn,      ///< Ackermann: steering angle [rad]; differential: yaw rate of the wheels [rad/s]
  kYawRate    ///< yaw rate of the vehicle [rad/s] (gyroscope)
};

/// What a GNSS receiver says of how it found its position.
enum class FixQuality : std::int8_t {
  kUnknown,       ///< not told: the deviation alone counts
  kSingle,        ///< pseudoranges alone
  kDifferential,  ///< with corrections of pseudoranges
  kFloat,         ///< carrier phase, ambiguities not whole
  kFixed          ///< carrier phase, ambiguities whole
};

/// One reading of one sensor.
struct Measurement {
  double time = 0.0;  ///< when it was true [s], on the clock of the run; it may arrive later
  MeasurementKind kind = MeasurementKind::kPosition;
  std::array<double, 2> value{};  ///< the second: y; of kHeading the measured baseline between
                                  ///< two antennas [m], 0: not told
  double deviation = 0.0;         ///< standard deviation of its noise, per component
  FixQuality quality = FixQuality::kUnknown;  ///< of kPosition and kHeading
};

}  // namespace headland
