// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/path.hpp"
#include "core/model/drive_cost.hpp"
#include "core/model/vehicle.hpp"
#include "global_planner/mission/mission_config.hpp"

namespace headland {

/// One item of a vehicle's tour.
struct PlanLeg {
  LegKind kind = LegKind::kRow;
  std::string id;  ///< row, poi, charger, or what is joined
  DriveCost cost;  ///< a charge has only a duration
  double soc_end = 1.0;
  int cusps = 0;
  double begin_s = 0.0;     ///< since the mission's start
  double wait_s = 0.0;      ///< stood still before that: for a slot, or until its time has come
  double earliest_s = 0.0;  ///< of a visit or a wait: not before
  int visit = -1;           ///< in Mission::visits
  double from_m = 0.0;  ///< of a row that is worked in parts: where this part begins and ends, from
  double to_m = 0.0;    ///< the row's first end; both 0: all of it
};

/// Driven without a stop but for gear changes; ends at a charger, a visit or the finish.
struct PlanStage {
  Path path;          ///< leg numbers index VehiclePlan::legs; empty if it only stands
  int stop_leg = -1;  ///< the charge or visit that follows; -1: none
};

struct VehiclePlan {
  std::string id;
  Vehicle vehicle;
  Pose2 start;
  double start_soc = 1.0;
  std::vector<PlanLeg> legs;
  std::vector<PlanStage> stages;
  double energy_j = 0.0;  ///< drawn over all legs, net
  double min_soc = 1.0;
  double shift_s = std::numeric_limits<double>::infinity();  ///< to be back by then
  double finish_s = 0.0;                                     ///< since the mission's start
  /// At any metre of the plan at least this is left above the reserve when the vehicle drives on to
  /// a charger, by the plan or by the nearest way [J]. Without chargers, or where it does not
  /// drive: above the reserve.
  double min_margin_j = 0.0;
};

/// Why a leg is there, or a task is not.
struct PlanReason {
  int vehicle = -1;  ///< in MissionPlan::vehicles; -1: of no vehicle
  int leg = -1;      ///< -1: a task left out
  std::string text;
};

/// A task left out.
struct DroppedWork {
  std::string id;  ///< "row north/r3"
  std::string reason;
};

enum class PlanStatus { kOptimal, kFeasible };

/// The global layer's answer.
struct MissionPlan {
  Objective objective = Objective::kEnergy;
  double value = 0.0;        ///< of the objective, rows included
  double lower_bound = 0.0;  ///< no plan that does the same tasks is cheaper
  bool proven = false;       ///< optimal
  double work_m = 0.0;
  double turn_m = 0.0;
  double transit_m = 0.0;
  double makespan_s = 0.0;
  int charge_stops = 0;
  double min_margin_j = 0.0;          ///< least of all vehicles'
  std::vector<VehiclePlan> vehicles;  ///< one per vehicle of the mission, idle ones without legs
  std::vector<PlanReason> reasons;
  std::vector<DroppedWork> dropped;

  double gap_ratio() const { return value == 0.0 ? 0.0 : (value - lower_bound) / std::abs(value); }
  PlanStatus status() const { return proven ? PlanStatus::kOptimal : PlanStatus::kFeasible; }
};

/// How long a plan may take, and who wants to know.
struct PlanningHooks {
  std::function<bool()> stop;                                  ///< true ends the search
  std::function<void(double fraction, double best)> progress;  ///< of the search
};

/// Plans a mission: verified ways between all row ends, places and chargers over the terrain, then
/// the tours of all vehicles with their charges (solve_tour), and the paths. Deterministic for the
/// configuration's seed unless `stop` is used. Errors: kTurnDoesNotFit, kNoPath, kTooSteep,
/// kOffTerrain, kEnergyInfeasible, kTaskDoesNotFit, each naming the row or place.
Result<MissionPlan> plan_mission(const Mission& mission, const PlanningHooks& hooks = {});

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::PlanStatus> {
  static constexpr std::pair<headland::PlanStatus, std::string_view> values[] = {
      {headland::PlanStatus::kOptimal, "optimal"}, {headland::PlanStatus::kFeasible, "feasible"}};
};
