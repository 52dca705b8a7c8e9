// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "global_planner/tour/tour_problem.hpp"

namespace headland::tour {

/// A point of the curve "earliest time by which a vehicle can be here with this much energy".
struct CurvePoint {
  double energy_j = 0.0;
  double time_s = 0.0;
};

/// Earliest time by energy, linear between points; both rise. With less energy than the first
/// point's nothing is gained in time; more than the last point's cannot be had. How long was
/// charged before is thus decided later (deferred charging; Montoya et al. 2017, Froger et al.
/// 2019, whose curves are the inverse of this one). Waiting is free, so that later is never better.
using EnergyCurve = std::vector<CurvePoint>;

/// What a battery allows: never below `floor_j`, never above `full_j`. Both may be infinite.
struct BatteryLimits {
  double floor_j = 0.0;
  double full_j = kNever;
};

/// Drives or works a leg: drops what falls below the floor on the way, shifts, caps at a full
/// battery. False (curve unspecified) if it cannot be done at all.
bool drive(EnergyCurve& curve, const TourLeg& leg, double duration_s, const BatteryLimits& battery);

/// Drops what holds less than `energy_j`. False if nothing is left.
bool need_energy(EnergyCurve& curve, double energy_j);

/// Waits until `earliest_s`; drops what is later than `latest_s`. False if nothing is left.
bool wait_window(EnergyCurve& curve, double earliest_s, double latest_s);

/// Charges for any time: from each point on along the charge function, whichever is earliest.
/// `at_once`: charging takes no time (or time is of no importance).
void charge(EnergyCurve& curve, const ChargeFunction& function, double full_j, bool at_once,
            EnergyCurve& scratch);

/// The energy with which to arrive at a station so as to leave it earliest with `leave_j`.
double best_arrival(std::span<const CurvePoint> arrival, const ChargeFunction& function,
                    double leave_j);

/// Earliest time with at least this energy; infinity if it cannot be had.
double time_at(std::span<const CurvePoint> curve, double energy_j);

/// Charging time from empty to this energy; infinity beyond the function's last point.
double charge_time(const ChargeFunction& function, double energy_j);
/// Energy reached from empty within this time.
double charged_energy(const ChargeFunction& function, double time_s);

/// The least, over the energies of `b`, by which b is later than a times `time_price`; -infinity
/// if b reaches more energy than a. `energy_slack_j` is what rounding may be off by.
double least_lead(std::span<const CurvePoint> a, std::span<const CurvePoint> b,
                  double energy_slack_j);

}  // namespace headland::tour
