// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "control/tracker.hpp"

namespace headland {

/// The fastest speed along a reference that keeps to its legs' speeds and can always brake in time
/// for the next slower leg and for a standstill at each cusp and at the end. Built once per
/// reference; asking it does not allocate.
class SpeedProfile {
 public:
  /// `deceleration` [m/s^2] > 0.
  void build(const Reference& reference, double deceleration);

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
  double deceleration_ = 1.0;
  std::vector<Knot> knots_;
};

}  // namespace headland
