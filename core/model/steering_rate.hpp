// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/geometry/curve.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

/// How a vehicle is driven where the curvature of its way changes faster than its steering.
struct SteeringPace {
  double rate_use_ratio = 0.95;    ///< share of the actuator's rate that is used
  double step_error_m = 0.02;      ///< at a step of curvature the way may be left by this [m]
  double least_speed_ratio = 0.2;  ///< of the speed wanted, below which it never slows down
};

/// A stretch driven more slowly.
struct SlowStretch {
  double length = 0.0;  ///< [m]
  double speed = 0.0;   ///< [m/s]
};

/// The fastest change of the steering angle on a clothoid [rad/m]: where it bends least.
double steering_per_metre(double wheelbase, double from, double to, double length);

/// Whether its yaw rate has no limit on its change: nothing here slows such a vehicle down.
bool yaws_immediately(const Vehicle& vehicle);

/// The sharpest change of curvature along the way that the vehicle follows at `speed` [m/s], from
/// straight wheels, where they are the slowest [1/m2]; infinite for a differential vehicle whose
/// yaw rate changes immediately.
double sharpness_limit(const Vehicle& vehicle, double speed, const SteeringPace& pace = {});

/// What a step of the curvature [1/m] asks of a vehicle: to be slow half of the stretch before it
/// and half behind. Curvature that changes by c over the length l, centred at the step, leaves the
/// way by c l^2 / 24 (twice integrated), and l = v t. The steering of an Ackermann vehicle takes
/// the same time t at all speeds, a differential one's is v c / (yaw acceleration). None where it
/// keeps up at `wanted` [m/s].
std::optional<SlowStretch> slow_at_step(const Vehicle& vehicle, double from, double to,
                                        double wanted, const SteeringPace& pace = {});

/// What a clothoid, between two curvatures [1/m], asks of it all along: a speed that its steering,
/// or its yaw acceleration, keeps up with.
std::optional<SlowStretch> slow_on_ramp(const Vehicle& vehicle, double from, double to,
                                        double length, double wanted,
                                        const SteeringPace& pace = {});

/// Time [s] that a vehicle loses against driving all of the curve at `wanted` [m/s]; the
/// curve lies between straights. Stretches nearer to each other than speeding up and braking take
/// count as one. At cusps the wheels turn while it stands.
double slow_down_time(const Vehicle& vehicle, const Curve& curve, double wanted,
                      const SteeringPace& pace = {});

}  // namespace headland
