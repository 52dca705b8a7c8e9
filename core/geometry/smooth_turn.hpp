// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "core/geometry/curve.hpp"

namespace headland {

/// What the steering allows along the way.
struct SteeringLimits {
  double curvature = 0.0;                                      ///< at most [1/m], > 0
  double sharpness = std::numeric_limits<double>::infinity();  ///< change of it at most [1/m2]
};

/// The sharpest turn of continuous curvature from a straight to a straight, to the left: a
/// clothoid, an arc at the limit and the clothoid back; for less than `least_with_arc()` two
/// clothoids that meet below the limit (Fraichard and Scheuer 2004; there small turns keep to the
/// circle of the others and so are longer). Without a limit to sharpness it is an arc.
///
/// Lengths are in turning radii: so is all that steering curves are computed from.
class SmoothTurn {
 public:
  explicit SmoothTurn(const SteeringLimits& limits);

  double radius() const { return radius_; }        ///< [m]
  double sharpness() const { return sharpness_; }  ///< of the clothoids [1/m2]
  bool has_ramps() const { return ramp_ > 0.0; }
  double ramp() const { return ramp_; }              ///< length of a whole clothoid
  double ramp_angle() const { return 0.5 * ramp_; }  ///< [rad] that it turns
  double least_with_arc() const { return ramp_; }    ///< [rad], two of it
  /// Centre of the arc, in the frame of the turn's start; seen from its end it is as far behind.
  double ahead() const { return ahead_; }
  double aside() const { return aside_; }

  /// A turn by an angle: its two ends lie on a chord in the direction of half the angle.
  struct Shape {
    double chord = 0.0;
    double slope = 0.0;  ///< d chord / d angle
    double sine = 0.0;   ///< of half the angle
    double cosine = 1.0;

    double along() const { return chord * cosine; }  ///< the chord along the first heading
    double across() const { return chord * sine; }
    /// The part of `along()` that a straight beyond it does not get back by turning with it:
    /// `ahead` of a turn with an arc.
    double give() const { return 0.5 * chord * cosine - slope * sine; }
  };
  /// @param angle [rad] >= 0, below 2 pi or with an arc.
  Shape shape(double angle) const;
  double length(double angle) const;

  /// Appends the turn [m], to the left for hand = 1, to the right for -1, driven forwards.
  /// @param angle [rad] >= 0, taken as 0 below `rounding`: then a straight as long as the chord.
  void append(Curve& curve, double angle, double hand, double rounding) const;

 private:
  double radius_;
  double sharpness_;
  double ramp_ = 0.0;
  double inverse_ramp_ = 0.0;
  double ahead_ = 0.0;
  double aside_ = 1.0;
};

}  // namespace headland
