// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "local_planner/local_planner.hpp"
#include "local_planner/outline.hpp"

namespace headland {

/// How the vehicle shall move on: what its wheels are driven towards.
struct Motion {
  double speed = 0.0;      ///< [m/s], negative: reverse
  double curvature = 0.0;  ///< of its way [1/m], positive left in both gears
  double pivot = 0.0;      ///< turning on the spot [rad/s]; differential vehicles only
};

/// The fastest that plans drive [m/s]: what is wanted, but not faster than the vehicle goes in this
/// gear, nor so fast in a curve [1/m] that it is thrown aside by more than 1 m/s2 (the limit of
/// control/speed_limits.hpp).
double speed_within(const Vehicle& vehicle, double wanted, Gear gear, double curvature);

/// The tightest curve that plans drive [1/m].
inline double tightest_curvature(const Vehicle& vehicle) { return 1.0 / vehicle.turning_radius(); }

/// The command that brings the vehicle to a motion within `step` [s], in spite of its lags, as far
/// as its limits let it; a curve is kept while the speed still changes.
Command command_for(const Vehicle& vehicle, const VehicleState& state, const Motion& motion,
                    double step);

/// The command with which the vehicle follows a plan at `time` [s, of the plan] for one cycle: the
/// plan's speed and steering at the cycle's end, the lags seen through. Where the plan is left
/// (fail-safe), the curve is the plan's and the speed as near to it as may be.
Command command_along(const Vehicle& vehicle, const VehicleState& state, const LocalPlan& plan,
                      double time, double cycle);

/// Begins a plan at the scene's robot, as planned so far: one state.
void begin_plan(const LocalScene& scene, double step, LocalPlan& plan);
/// Drives the plan on by one step.
void drive_on(const Vehicle& vehicle, const Motion& motion, LocalPlan& plan);

/// Whether the plan keeps off static obstacles (but for one that the vehicle touches already: that
/// it may always leave), and so does braking along the curve that the vehicle is on after `commit`
/// [s] of it: what is driven before the next plan can be stopped.
bool stays_clear(const Vehicle& vehicle, const OutlineDiscs& outline, const ClearanceMap* map,
                 const LocalPlan& plan, double commit, LocalPlan& scratch);

/// The nearest that a plan comes to agents that keep their velocity.
struct Approach {
  double gap = 1e3;   ///< outline to disc [m]; negative: contact
  double time = 0.0;  ///< from the plan's begin [s]
  int agent = -1;     ///< index into the scene's agents; -1: there are none
};
Approach nearest_approach(const Footprint& outline, const LocalScene& scene, const LocalPlan& plan);

}  // namespace headland
