// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace headland {

/// How the ground lets a vehicle down: what its wheels and its steering promise, against what it
/// does. All zero: the ideal kinematics.
struct Slip {
  /// Longitudinal slip s: the vehicle goes (1 - s) times as far as its wheels roll; below zero it
  /// is pushed.
  double loss_ratio = 0.0;
  /// Side slip beta [rad]: the direction of travel against the heading, positive left. In reverse
  /// the vehicle drives against that direction.
  double side_rad = 0.0;
  /// Steering offset alpha [rad], added to the steering angle. A differential vehicle has it as an
  /// offset tan(alpha) / wheelbase of its curvature (its sides slip differently).
  double steering_offset_rad = 0.0;
};

}  // namespace headland
