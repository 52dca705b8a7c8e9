// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/run/run_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace headland {
namespace {

void add(const EncounterMetrics& one, EncounterMetrics& all) {
  all.takeovers += one.takeovers;
  all.local_s += one.local_s;
  all.held_s += one.held_s;
  all.protective_stops += one.protective_stops;
  all.near_collisions += one.near_collisions;
  all.robot_near += one.robot_near;
  all.collisions += one.collisions;
  all.robot_collisions += one.robot_collisions;
  all.least_gap_m = std::min(all.least_gap_m, one.least_gap_m);
}

}  // namespace

void count_rows(std::span<const VehiclePlan> plans, std::span<const Run> runs,
                RunMetrics& metrics) {
  std::map<std::string, bool> done;
  for (std::size_t v = 0; v < plans.size(); ++v) {
    const std::vector<PlanLeg>& driven = runs[v].driven.legs;
    for (std::size_t i = 0; i < driven.size(); ++i) {
      if (driven[i].kind != LegKind::kRow) continue;
      const auto row = done.emplace(driven[i].id, true).first;
      row->second = row->second && runs[v].leg_done[i];
    }
    for (const PlanLeg& leg : plans[v].legs) {
      if (leg.kind == LegKind::kRow) done.emplace(leg.id, false);
    }
  }
  metrics.rows_total = static_cast<int>(done.size());
  metrics.rows_done = static_cast<int>(
      std::count_if(done.begin(), done.end(), [](const auto& row) { return row.second; }));
}

TrackingMetrics fleet_tracking(std::span<const Run> runs) {
  std::vector<PathError> errors;
  std::vector<LegKind> kinds;
  for (std::size_t v = 0; v < runs.size(); ++v) {
    const int offset = static_cast<int>(kinds.size());
    for (const TraceRow& row : runs[v].trace) {
      if (row.driving == Driving::kLocal) continue;  // off the path on purpose
      errors.push_back({row.s_m, row.cross_track_m, std::abs(row.cross_track_m), offset + row.leg});
    }
    for (const PlanLeg& leg : runs[v].driven.legs) kinds.push_back(leg.kind);
  }
  return tracking_metrics(errors, kinds);
}

RunMetrics fleet_metrics(const std::vector<VehiclePlan>& plans, const std::vector<Run>& runs) {
  RunMetrics all;
  all.completed = true;
  for (const Run& run : runs) {
    const RunMetrics& one = run.metrics;
    all.completed = all.completed && one.completed;
    if (all.reason.empty()) all.reason = one.reason;
    all.visits_done += one.visits_done;
    all.visits_total += one.visits_total;
    all.charges += one.charges;
    all.energy_j += one.energy_j;
    all.duration_s = std::max(all.duration_s, one.duration_s);
    all.waited_s += one.waited_s;
    all.min_soc = std::min(all.min_soc, one.min_soc);
    all.reserve_kept = all.reserve_kept && one.reserve_kept;
    all.wrong_gear_count += one.wrong_gear_count;
    all.stale_plan_count += one.stale_plan_count;
    all.replans += one.replans;
    all.failed_replans += one.failed_replans;
    add(one.encounters, all.encounters);
    all.rows_seen.add(one.rows_seen);
  }
  count_rows(plans, runs, all);
  all.tracking = fleet_tracking(runs);
  return all;
}

}  // namespace headland
