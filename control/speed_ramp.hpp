// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

namespace headland {

/// Which speeds a vehicle can be told next, one cycle after the other, at its acceleration. They go
/// on from the speed told before. Going on from the measured speed instead would brake and speed up
/// too slowly: every reading that is off the wrong way takes back what the last cycle gained, so
/// that noise of 2 cm/s at 50 Hz halves the acceleration. Where a vehicle does not follow, they
/// stay within half a second's acceleration of the measured speed. Does not allocate.
class SpeedRamp {
 public:
  /// `acceleration` [m/s^2] > 0.
  explicit SpeedRamp(double acceleration) : acceleration_(acceleration) {}

  struct Reach {
    double low = 0.0;   // [m/s]
    double high = 0.0;  // [m/s]
  };

  /// Forgets what was told: the measured speed is where the next one goes on from.
  void reset() { told_.reset(); }
  /// Speeds within reach `dt` [s] later, of a vehicle measured to drive at `measured` [m/s].
  Reach reach(double measured, double dt) const {
    const double slack = 0.5 * acceleration_;
    const double from = std::clamp(told_.value_or(measured), measured - slack, measured + slack);
    return {from - acceleration_ * dt, from + acceleration_ * dt};
  }
  /// That is what the vehicle is told [m/s].
  void tell(double speed) { told_ = speed; }

 private:
  double acceleration_;
  std::optional<double> told_;
};

}  // namespace headland
