// SPDX-License-Identifier: Apache-2.0
#pragma once

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
  std::string id;  ///< row, charger, or what is joined
  DriveCost cost;  ///< a charge has only a duration
  double soc_end = 1.0;
  int cusps = 0;
};

/// Driven without a stop but for gear changes; ends at a charger or at the finish.
struct PlanStage {
  Path path;            ///< leg numbers index VehiclePlan::legs
  int charge_leg = -1;  ///< the charge that follows; -1: none
};

struct VehiclePlan {
  std::string id;
  Vehicle vehicle;
  double start_soc = 1.0;
  std::vector<PlanLeg> legs;
  std::vector<PlanStage> stages;
  double energy_j = 0.0;  ///< drawn over all legs
  double min_soc = 1.0;
};

enum class PlanStatus { kOptimal, kFeasible };

/// The global layer's answer.
struct MissionPlan {
  Objective objective = Objective::kEnergy;
  double value = 0.0;        ///< of the objective, rows included
  double lower_bound = 0.0;  ///< no plan for this mission is cheaper
  double work_m = 0.0;
  double turn_m = 0.0;
  double transit_m = 0.0;
  double makespan_s = 0.0;
  int charge_stops = 0;
  std::vector<VehiclePlan> vehicles;

  double gap_ratio() const { return value > 0.0 ? (value - lower_bound) / value : 0.0; }
  /// Optimal where the bound proves it.
  PlanStatus status() const {
    return gap_ratio() <= 1e-9 ? PlanStatus::kOptimal : PlanStatus::kFeasible;
  }
};

/// Plans a mission: verified ways between all row ends and chargers, the cheapest order of rows,
/// the cheapest recharge stops for that order (and for its reverse; the cheaper one wins), and the
/// path. Deterministic for the configuration's seed. Errors: kTurnDoesNotFit, kNoPath,
/// kEnergyInfeasible, each naming the row.
Result<MissionPlan> plan_mission(const Mission& mission);

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::PlanStatus> {
  static constexpr std::pair<headland::PlanStatus, std::string_view> values[] = {
      {headland::PlanStatus::kOptimal, "optimal"}, {headland::PlanStatus::kFeasible, "feasible"}};
};
