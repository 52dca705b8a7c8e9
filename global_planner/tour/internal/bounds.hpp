// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "global_planner/tour/tour_problem.hpp"

namespace headland::tour {

/// No solution of the problem costs less. Every task has one predecessor and one successor, or is
/// left out for its reward; each vehicle is a node that is left and entered, or unused: the
/// cheapest such assignment over ways that windows and batteries do not rule out, each by the best
/// of all stations. Raised by prices for cycles without a vehicle and for sets of tasks that need
/// several loads, and by a price for time where the vehicles' time is short. Minus infinity where
/// ways by stations cost less and less. Deterministic if `stop` (may be empty) is not used; a few
/// seconds at most.
double lower_bound(const TourProblem& problem, const std::function<bool()>& stop = {});

/// Vehicles that all mandatory tasks need at least by their loads (Martello and Toth 1990, L2).
int least_vehicles(const TourProblem& problem);

}  // namespace headland::tour
