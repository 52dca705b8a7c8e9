// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "control/tracker.hpp"

namespace headland {

/// A stretch of a path that is to be driven slowly.
struct SpeedZone {
  double begin_s = 0.0;  ///< [m]
  double end_s = 0.0;    ///< [m]
  double speed = 0.0;    ///< [m/s] > 0
};

/// The fastest speed along a reference that keeps to its legs' speeds and can always brake in time
/// for the next slower leg and for a standstill at each cusp and at the end. Built once per
/// reference; asking it does not allocate.
class SpeedProfile {
 public:
  /// `deceleration` [m/s^2] > 0. `zones` in the order of their begins; they may overlap.
  void build(const Reference& reference, double deceleration,
             std::span<const SpeedZone> zones = {});

  /// Speed [m/s, >= 0] to command for the next `dt` [s] at driven distance `s` [m] on the segment
  /// numbered `segment`; zero at the segment's end. O(log pieces).
  double limit(double s, int segment, double dt) const;

 private:
  struct Knot {
    double s = 0.0;      // [m]
    double speed = 0.0;  // [m/s] allowed when passing s, braking for what follows included
    double after = 0.0;  // [m/s] the leg's own speed from here on
    int segment = 0;
  };
  void add_piece(double begin_s, double end_s, double speed, int segment,
                 std::span<const SpeedZone> zones);
  void brake_in_time();

  double deceleration_ = 1.0;
  std::vector<Knot> knots_;
};

}  // namespace headland
