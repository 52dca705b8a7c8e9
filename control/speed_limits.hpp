// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "control/tracker.hpp"
#include "core/config/visit.hpp"
#include "core/model/vehicle.hpp"
#include "core/world/ground.hpp"

namespace headland {

/// How fast a vehicle may go where its path bends, its steering must turn or the ground is heavy.
struct SpeedLimitConfig {
  /// Speed squared times curvature stays within this [m/s2]. 1.0: 6 km/h, the fastest turn that
  /// GOtrack's autopilot for orchard tractors recommends ("Speed management", help.gotrack.pl), at
  /// a radius of 2.8 m; it is a seventh of what overturns a narrow tractor, g track / (2 height)
  /// (Gillespie 1992, ch. 9) with 1.2 m and 0.8 m. 1000: no limit.
  double max_lateral_mps2 = 1.0;
  /// Share of the steering rate (differential: of the yaw acceleration) that the path may take.
  double steering_use_ratio = 0.95;
  /// At a step of curvature the vehicle slows down so far that a ramp there, split evenly, is off
  /// the path by no more than this [m] ...
  double step_error_m = 0.02;
  /// ... but neither for the steering nor for economy below this share of the leg's speed.
  double least_speed_ratio = 0.2;
  /// How far the speed goes down from the leg's towards that of the least energy per metre, where
  /// that is lower. 0: not at all.
  double economy_ratio = 0.0;
  /// Share of the vehicle's deceleration with which it is planned to brake. Wheels that slip by s
  /// brake over the ground with 1 - s of theirs.
  double brake_ratio = 1.0;

  template <class V>
  void visit(V& v) {
    v("max_lateral_mps2", max_lateral_mps2, config::Range{0.05, 1000.0},
      "Largest lateral acceleration, speed squared times curvature [m/s2]; 1000: no limit");
    v("steering_use_ratio", steering_use_ratio, config::Range{0.2, 1.0},
      "Share of the steering rate, or of the yaw acceleration, that the path may take");
    v("step_error_m", step_error_m, config::kPositive,
      "The vehicle slows down at a step of curvature for this error [m]");
    v("least_speed_ratio", least_speed_ratio, config::Range{0.05, 1.0},
      "Steering and economy do not slow down below this share of the leg's speed; 1: never");
    v("economy_ratio", economy_ratio, config::kFraction,
      "How far the speed goes down towards that of the least energy per metre; 0: not at all");
    v("brake_ratio", brake_ratio, config::Range{0.05, 1.0},
      "Share of the vehicle's deceleration with which it is planned to brake");
  }
};

/// Where along a reference the vehicle must be slower than its legs' speeds: v^2 |kappa| within
/// max_lateral_mps2 (clothoids in short zones, so that the speed varies along them), the steering
/// (steering_zones), Vehicle::reverse_speed_mps in reverse gear, and Reference::zones. In order,
/// disjoint. O(n log n).
std::vector<SpeedZone> speed_zones(const Reference& reference, const Vehicle& vehicle,
                                   const SpeedLimitConfig& config);

/// Where the path's curvature steps so far, or a clothoid is so sharp, that the steering is too
/// slow for the leg's speed; of differential vehicles their yaw acceleration at a steady speed. In
/// the order of their begins; they may overlap.
std::vector<SpeedZone> steering_zones(const Reference& reference, const Vehicle& vehicle,
                                      const SpeedLimitConfig& config);

/// Where the energy model on this ground allows or advises less than the legs' speeds: power at the
/// wheels within EnergyModel::drive_power_w (at a steady speed; speeding up comes on top), and
/// economy_ratio. Whoever has the ground puts it into Reference::zones. Heights off the terrain
/// count as level. In order, disjoint; empty with both off. In steps of Ground::step().
std::vector<SpeedZone> energy_zones(const Reference& reference, const Vehicle& vehicle,
                                    const SpeedLimitConfig& config, const Ground& ground);

/// Speed in (0, wanted] [m/s] at which a step, its speeds and duration left open, takes no more
/// than `power` [W] at the wheels.
double speed_within_power(const EnergyModel& model, DriveStep step, double power, double wanted);

/// Speed in [least, most] [m/s] of the least energy over a step, its speeds and duration left open.
double economic_speed(const EnergyModel& model, DriveStep step, double least, double most);

}  // namespace headland
