// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "global_planner/coverage/transitions.hpp"
#include "global_planner/mission/mission_plan.hpp"
#include "global_planner/tour/recharge.hpp"
#include "global_planner/tour/row_tour.hpp"

namespace headland::mission {

/// Numbers of the sites of a one-vehicle mission: row ends, start, finish, chargers.
struct SiteIndex {
  int rows = 0;
  int chargers = 0;

  int start() const { return 2 * rows; }
  int finish() const { return 2 * rows + 1; }
  int charger(int c) const { return 2 * rows + 2 + c; }
};

/// The vehicle has to fit where it starts, ends and charges, and all along its rows: an Error that
/// names the first place where its outline leaves the drivable area or enters a keep-out.
std::optional<Error> check_standing_places(const Mission& mission);

/// Lower bound [objective's unit] on what the charge stops add to any order of rows that costs at
/// least `tour_bound`: the fewest stops the battery allows, each at the smallest detour there is.
double forced_detours(const Mission& mission, const Transitions& transitions,
                      const SiteIndex& sites, double tour_bound);

/// Legs and paths of the tour.
VehiclePlan build_vehicle_plan(const Mission& mission, const Transitions& transitions,
                               const SiteIndex& sites, const std::vector<RowVisit>& visits,
                               const std::vector<ChargeStop>& stops);

/// Sums over all vehicles' legs into the plan's totals.
void add_totals(MissionPlan& plan);

/// What driving each of the mission's rows costs, in their order.
std::vector<DriveCost> row_costs(const Mission& mission);

/// The solvers speak of numbers ("row 4", "item 4"); this puts the rows' names in their place.
/// `numbered`: the rows, by the number behind `word`.
Error with_row_name(Error error, const std::string& word, const Mission& mission,
                    const std::vector<RowRef>& numbered);

}  // namespace headland::mission
