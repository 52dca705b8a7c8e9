// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/result.hpp"
#include "global_planner/mission/mission_config.hpp"
#include "global_planner/mission/mission_plan.hpp"

namespace headland {

/// How far a vehicle is on its plan.
struct PlanProgress {
  int leg = 0;              ///< under way, in VehiclePlan::legs
  double done_ratio = 0.0;  ///< of that leg, by length
};

/// Energy [J] that is left above the reserve when the vehicle comes to its next charger, or to the
/// finish if there is none, at the lowest moment until then; negative: it will fall below. If all
/// that is still to be driven costs what was planned for it, times 1 + `margin_ratio`. O(legs).
double spare_energy(const VehiclePlan& plan, const PlanProgress& progress, double soc,
                    double margin_ratio = 0.0);

/// Where a vehicle stands when the rest of its mission is planned anew.
struct Standing {
  Pose2 pose;
  double soc = 1.0;
  double time_s = 0.0;  ///< since the mission's start
  int next_leg = 0;     ///< the first of its plan's legs that has not begun
};

/// What of a mission is left to one vehicle.
struct RestOfMission {
  Mission mission;          ///< with that vehicle alone
  std::vector<int> visits;  ///< of its visits: their numbers in the whole mission
};
/// The mission of one vehicle from where it stands: its rows and visits that have not begun, its
/// own finish, times counted from now. A row that is worked in parts and has a part left is worked
/// whole. What does not fit any more may be dropped.
/// @return kNoRows if nothing is left to do.
Result<RestOfMission> rest_of_mission(const Mission& mission, std::size_t vehicle,
                                      const VehiclePlan& plan, const Standing& standing);

/// Plans that rest. Times of the answer count from `standing`; its visits have the whole mission's
/// numbers.
/// @return Errors of rest_of_mission and plan_mission.
Result<VehiclePlan> replan(const Mission& mission, std::size_t vehicle, const VehiclePlan& plan,
                           const Standing& standing, const PlanningHooks& hooks = {});

}  // namespace headland
