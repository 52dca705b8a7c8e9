// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.hpp"

namespace headland {

/// A fixed sequence of work with a choice, between any two of its items (and before the first and
/// after the last), to go straight on or by way of one of several chargers.
struct RechargeProblem {
  struct Way {
    double cost = 0.0;  ///< in the objective's unit; infinity: no such way
    double energy_j = 0.0;
  };
  /// Gap i lies before item i; gap n, after the last item, leads to the finish.
  struct Gap {
    Way direct;
    std::vector<Way> to_charger;    ///< one per charger
    std::vector<Way> from_charger;  ///< one per charger
  };
  std::vector<double> item_energy_j;  ///< n
  std::vector<Gap> gaps;              ///< n + 1
  /// Extra cost of a stop at a charger that restores `energy_j`: fixed + per_joule * energy (the
  /// time it takes, where time is the objective; zero for energy).
  double stop_cost = 0.0;
  std::vector<double> stop_cost_per_j;  ///< one per charger
  double start_energy_j = 0.0;          ///< in the battery at the start
  double capacity_j = 0.0;              ///< full
  double reserve_j = 0.0;               ///< never below, on arrival anywhere
};

/// Charge to full at charger `charger` in gap `gap`.
struct ChargeStop {
  int gap = 0;
  int charger = 0;
};

struct RechargePlan {
  std::vector<ChargeStop> stops;
  double cost = 0.0;  ///< of all ways and stops, items not counted
};

/// The cheapest set of stops for the given order, exactly (shortest path over "last charged at",
/// O(n^2 chargers^2) worst case, far less where the battery is small). Several chargers in one gap
/// are not considered. Error kEnergyInfeasible names the item that no plan can serve and how much
/// energy is missing.
Result<RechargePlan> plan_recharges(const RechargeProblem& problem);

/// What every plan of a mission must at least spend, in energy; for a bound on its cost.
struct RechargeBound {
  double energy_j = 0.0;      ///< least energy of all work and ways, were the battery endless
  double start_j = 0.0;       ///< in the battery at the start, above the reserve
  double per_charge_j = 0.0;  ///< most that one stop restores: full less the reserve
  double detour_cost = 0.0;   ///< least extra cost of one stop (>= 0), in the objective's unit
};

/// Stops that no plan can do without: what the start does not cover, by full charges. -1: no
/// number of stops is enough.
int min_charge_stops(const RechargeBound& bound);

/// Cost that recharging adds at least to a lower bound of the tour without it: the stops that no
/// plan can do without, each by the cheapest detour. Infinity if no number of stops is enough.
double recharge_lower_bound(const RechargeBound& bound);

}  // namespace headland
