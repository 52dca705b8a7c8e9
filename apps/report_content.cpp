// SPDX-License-Identifier: Apache-2.0
#include "apps/report_content.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "apps/agent_tracks.hpp"
#include "apps/film_scene.hpp"
#include "apps/plan_output.hpp"
#include "apps/report_terrain.hpp"

namespace headland::apps {
namespace {

constexpr double kPlanSpacing = 0.25;   // of the drawn plan's points [m]
constexpr double kSeriesSpacing = 1.0;  // of a plan's series [m]
constexpr double kTerrainRim = 0.2;     // of the map's longer side, around it
constexpr int kMostCells = 400;         // of a study's table

void add_areas(const std::vector<Polygon>& areas, const char* kind, Report& report) {
  for (const Polygon& area : areas)
    report.features.push_back(ReportFeature::polygon(kind, "", area));
}

void add_farm(const Farm& farm, const std::set<std::string>& rows_done, Report& report) {
  add_areas(drivable_area(farm), "headland", report);
  for (const RowParcel& parcel : farm.row_parcels) {
    report.features.push_back(ReportFeature::polygon(
        "parcel", parcel.name.empty() ? parcel.id : parcel.name, parcel.boundary));
  }
  for (const FreeParcel& parcel : farm.free_parcels) {
    report.features.push_back(ReportFeature::polygon("parcel", parcel.id, parcel.boundary));
  }
  for (const Road& road : farm.roads) {
    report.features.push_back(ReportFeature::line("road", road.id, road.line));
  }
  for (const KeepOut& keep_out : farm.keep_outs) {
    report.features.push_back(ReportFeature::polygon("keep_out", keep_out.id, keep_out.boundary));
  }
  for (const RowParcel& parcel : farm.row_parcels) {
    for (const Row& row : parcel.rows) {
      const std::string name = parcel.id + "/" + row.id;
      report.features.push_back(
          ReportFeature::line(rows_done.count(name) > 0 ? "row_done" : "row", name, row.line));
    }
  }
  for (const Gate& gate : farm.gates) {
    report.features.push_back(ReportFeature::point("gate", gate.id, gate.position));
  }
  for (const Poi& poi : farm.pois) {
    report.features.push_back(ReportFeature::point("poi", poi.id, poi.pose.position()));
  }
  for (const Charger& charger : farm.chargers) {
    report.features.push_back(ReportFeature::point("charger", charger.id, charger.pose.position()));
  }
}

Polyline leg_line(const Path& path, int leg) {
  const auto [begin, end] = path.leg_range(leg);
  Polyline line;
  const int steps = std::max(1, static_cast<int>(std::ceil((end - begin) / kPlanSpacing)));
  for (int i = 0; i <= steps; ++i) {
    line.push_back(path.at(begin + (end - begin) * i / steps).pose.position());
  }
  return line;
}

void add_planned_path(const VehiclePlan& plan, int vehicle, Report& report) {
  std::size_t stage = 0;
  for (int i = 0; i < static_cast<int>(plan.legs.size()); ++i) {
    const PlanStage& driven = plan.stages[stage];
    if (driven.stop_leg == i) {
      ++stage;
      continue;
    }
    const PlanLeg& leg = plan.legs[static_cast<std::size_t>(i)];
    ReportFeature feature = ReportFeature::line("plan", leg.id, leg_line(driven.path, i));
    feature.vehicle = vehicle;
    feature.leg = i;
    feature.leg_kind = config::enum_name(leg.kind);
    report.features.push_back(std::move(feature));
  }
}

double rounded(double value, double unit) { return std::round(value / unit) * unit; }

ReportTable leg_table(const std::vector<VehiclePlan>& plans) {
  ReportTable table{"Legs",
                    {{"vehicle"},
                     {"leg"},
                     {"kind"},
                     {"name"},
                     {"length", "m"},
                     {"duration", "s"},
                     {"energy", "Wh"},
                     {"charge at end", "%"}},
                    {}};
  for (const VehiclePlan& plan : plans) {
    for (std::size_t i = 0; i < plan.legs.size(); ++i) {
      const PlanLeg& leg = plan.legs[i];
      table.rows.push_back(
          {plan.id, static_cast<double>(i), std::string(config::enum_name(leg.kind)), leg.id,
           rounded(leg.cost.length_m, 0.1), rounded(leg.cost.duration_s, 1.0),
           rounded(leg.cost.energy_j / 3600.0, 0.1), rounded(100.0 * leg.soc_end, 0.1)});
    }
  }
  if (plans.size() > 1) return table;
  table.columns.erase(table.columns.begin());
  for (auto& row : table.rows) row.erase(row.begin());
  return table;
}

double soc_before(const VehiclePlan& plan, int leg) {
  return leg <= 0 ? plan.start_soc : plan.legs[static_cast<std::size_t>(leg - 1)].soc_end;
}

// Planned speed and state of charge along the path, for a plan that nobody has driven yet.
ReportSeries planned_series(const VehiclePlan& plan) {
  ReportSeries series;
  double offset = 0.0;
  for (const PlanStage& stage : plan.stages) {
    if (stage.path.empty()) continue;
    for (const PathSample& sample : stage.path.sample(kSeriesSpacing)) {
      const PlanLeg& leg = plan.legs[static_cast<std::size_t>(sample.leg)];
      const double soc = soc_before(plan, sample.leg);
      const auto [begin, end] = stage.path.leg_range(sample.leg);
      const double part = end > begin ? (sample.s - begin) / (end - begin) : 1.0;
      series.s_m.push_back(offset + sample.s);
      series.x_m.push_back(sample.pose.x);
      series.y_m.push_back(sample.pose.y);
      series.soc.push_back(soc + part * (leg.soc_end - soc));
      series.speed_mps.push_back(leg_speed(plan.vehicle, leg.kind));
      series.leg.push_back(sample.leg);
    }
    offset += stage.path.length();
  }
  return series;
}

// The charges of a plan; `run`, if there is one, says which came about and how.
std::vector<ReportStop> charge_stops(const VehiclePlan& plan, const Run* run) {
  std::vector<ReportStop> stops;
  double s = 0.0;
  for (const PlanStage& stage : plan.stages) {
    s += stage.path.length();
    if (stage.stop_leg < 0) continue;
    const auto at = static_cast<std::size_t>(stage.stop_leg);
    const PlanLeg& leg = plan.legs[at];
    if (leg.kind != LegKind::kCharge || (run != nullptr && !run->leg_done[at])) continue;
    ReportStop stop{s, soc_before(plan, stage.stop_leg), leg.soc_end, leg.id};
    if (run != nullptr) {
      const auto after =
          std::find_if(run->trace.begin(), run->trace.end(),
                       [&stage](const TraceRow& row) { return row.leg > stage.stop_leg; });
      if (after != run->trace.end()) stop.soc_to = after->soc;
      if (after != run->trace.begin()) stop.soc_from = std::prev(after)->soc;
    }
    stops.push_back(std::move(stop));
  }
  return stops;
}

ReportSeries driven_series(const Run& run) {
  std::vector<double> errors;
  errors.reserve(run.trace.size());
  for (const TraceRow& row : run.trace) errors.push_back(row.cross_track_m);
  ReportSeries series;
  double s = 0.0;
  for (const int i : thin_out(static_cast<int>(run.trace.size()), errors, kMaxReportPoints)) {
    const TraceRow& row = run.trace[static_cast<std::size_t>(i)];
    s = std::max(s, row.s_m);  // the projection may step back a hair at a cusp
    series.s_m.push_back(s);
    series.x_m.push_back(row.x_m);
    series.y_m.push_back(row.y_m);
    series.error_m.push_back(row.cross_track_m);
    series.steering_deg.push_back(rad_to_deg(row.steering_rad));
    series.soc.push_back(row.soc);
    series.speed_mps.push_back(row.speed_mps);
    series.leg.push_back(row.leg);
    series.t_s.push_back(row.t_s);
    series.yaw_rad.push_back(row.yaw_rad);
  }
  const bool steers = std::any_of(series.steering_deg.begin(), series.steering_deg.end(),
                                  [](double angle) { return angle != 0.0; });
  if (!steers) series.steering_deg.clear();
  return series;
}

ReportTile tile(const std::string& label, double value, double unit, const std::string& unit_name,
                const std::string& hint = {}) {
  return {label, rounded(value, unit), unit_name, hint};
}

void add_plan_tiles(const PlannedMission& planned, Report& report) {
  const MissionPlan& plan = planned.plan;
  double energy_j = 0.0;
  for (const VehiclePlan& vehicle : plan.vehicles) energy_j += vehicle.energy_j;
  report.tiles.push_back(tile("Rows' length", plan.work_m / 1000.0, 0.01, "km"));
  report.tiles.push_back(tile("Turns", plan.turn_m, 1.0, "m"));
  report.tiles.push_back(tile("Transit", plan.transit_m, 1.0, "m"));
  report.tiles.push_back(tile("Planned energy", energy_j / 3.6e6, 0.01, "kWh"));
  report.tiles.push_back({"Planned duration", duration_text(plan.makespan_s), "", ""});
  report.tiles.push_back(tile("Charge stops", plan.charge_stops, 1.0, ""));
  report.tiles.push_back(tile("Least margin", plan.min_margin_j / 3.6e6, 0.01, "kWh",
                              "left above the reserve at a charger, from anywhere"));
  if (!plan.dropped.empty()) {
    report.tiles.push_back(
        tile("Left out", static_cast<double>(plan.dropped.size()), 1.0, "tasks", "see why below"));
  }
  report.tiles.push_back(tile("Gap", 100.0 * plan.gap_ratio(), 0.01, "%",
                              "how far the plan is from a bound that no plan can beat"));
  report.tiles.push_back(tile("Planning", planned.planning_s, 0.01, "s"));
}

std::vector<ReportReason> why(const MissionPlan& plan) {
  std::vector<ReportReason> reasons;
  for (const PlanReason& reason : plan.reasons) {
    reasons.push_back({reason.vehicle, reason.leg, reason.text});
  }
  return reasons;
}

// Around all that the map shows, and a little more.
MapBox map_extent(const std::vector<ReportFeature>& features) {
  MapBox box;
  for (const ReportFeature& feature : features) {
    for (const Polyline& ring : feature.rings) {
      for (const Point2& p : ring) box.extend(p);
    }
  }
  if (box.isEmpty()) return box;
  const double rim = kTerrainRim * box.sizes().maxCoeff();
  return {box.min() - Point2(rim, rim), box.max() + Point2(rim, rim)};
}

Report base_report(const PlannedMission& planned, ReportKind kind,
                   const std::set<std::string>& rows_done) {
  Report report;
  report.title = planned.mission.config.name;
  report.kind = kind;
  report.status = config::enum_name(planned.plan.status());
  report.version = planned.stamp.version;
  report.seed = planned.stamp.seed;
  report.config_hash = planned.stamp.config_hash;
  report.config_yaml = planned.stamp.config_yaml;
  const MissionPlan& plan = planned.plan;
  add_farm(planned.mission.farm, rows_done, report);
  for (std::size_t v = 0; v < plan.vehicles.size(); ++v) {
    const VehiclePlan& vehicle = plan.vehicles[v];
    report.vehicles.push_back({vehicle.id, vehicle.vehicle.battery.reserve_soc, {}, {}});
    add_planned_path(vehicle, static_cast<int>(v), report);
  }
  if (!planned.mission.ground.flat()) {
    report.terrain = terrain_raster(planned.mission.ground, map_extent(report.features));
  }
  report.why = why(plan);
  report.tables.push_back(leg_table(plan.vehicles));
  return report;
}

}  // namespace

Report plan_report(const PlannedMission& planned) {
  Report report = base_report(planned, ReportKind::kPlan, {});
  if (planned.plan.vehicles.size() > 1) {
    report.tiles.push_back(
        tile("Vehicles", static_cast<double>(planned.plan.vehicles.size()), 1.0, ""));
  }
  report.tiles.push_back(tile("Rows", static_cast<double>(planned.mission.rows.size()), 1.0, ""));
  add_plan_tiles(planned, report);
  for (std::size_t v = 0; v < report.vehicles.size(); ++v) {
    report.vehicles[v].series = planned_series(planned.plan.vehicles[v]);
    report.vehicles[v].stops = charge_stops(planned.plan.vehicles[v], nullptr);
  }
  return report;
}

namespace {

// Thinned out, as a page has to be loaded.
ReportAgents agents_about(const FleetRun& run) {
  constexpr std::size_t kMostPositions = 60000;
  if (run.agents.empty()) return {};
  const std::size_t positions = run.agents.size() * run.agents.front().agents.size();
  const std::size_t stride = 1 + positions / kMostPositions;
  std::vector<AgentsAt> sights;
  for (std::size_t k = 0; k < run.agents.size(); k += stride) {
    sights.push_back({run.agents[k].t_s, run.agents[k].agents});
  }
  return agent_tracks(sights);
}

}  // namespace

Report run_report(const PlannedMission& planned, const FleetRun& run, double real_time_factor) {
  std::set<std::string> rows_done;
  for (std::size_t v = 0; v < run.vehicles.size(); ++v) {
    const std::vector<PlanLeg>& legs = planned.plan.vehicles[v].legs;
    for (std::size_t i = 0; i < legs.size(); ++i) {
      if (legs[i].kind == LegKind::kRow && run.vehicles[v].leg_done[i])
        rows_done.insert(legs[i].id);
    }
  }
  Report report = base_report(planned, ReportKind::kRun, rows_done);
  const RunMetrics& m = run.metrics;
  report.status = m.completed ? "completed" : "failed";
  report.agents = agents_about(run);
  report.seed = planned.config.simulation.seed;
  report.tiles.push_back(
      {"Rows done", fmt::format("{} / {}", m.rows_done, m.rows_total), "", m.reason});
  report.tiles.push_back(
      tile("Error in rows", 1000.0 * m.tracking.row_rms_m, 0.1, "mm", "cross-track, RMS"));
  report.tiles.push_back(
      tile("Error in turns", 1000.0 * m.tracking.turn_rms_m, 0.1, "mm", "cross-track, RMS"));
  report.tiles.push_back(
      tile("Largest error", 1000.0 * m.tracking.max_m, 0.1, "mm", "cross-track"));
  report.tiles.push_back(tile("Energy drawn", m.energy_j / 3.6e6, 0.01, "kWh"));
  report.tiles.push_back(tile("Lowest charge", 100.0 * m.min_soc, 0.1, "%"));
  report.tiles.push_back(
      {"Duration", duration_text(m.duration_s), "",
       fmt::format("simulated {:.0f} times faster than real time", real_time_factor)});
  if (m.rows_seen.scans > 0) {
    report.tiles.push_back(
        tile("Rows seen", 100.0 * m.rows_seen.valid_ratio(), 0.1, "%",
             fmt::format("of scans; {:.0f} mm off in the mean, {:.0f} mm at most",
                         1000.0 * m.rows_seen.mae_m(), 1000.0 * m.rows_seen.largest_m)));
  }
  if (!run.agents.empty()) {
    const EncounterMetrics& e = m.encounters;
    report.tiles.push_back({"Path left", fmt::format("{}", e.takeovers), "times",
                            fmt::format("for {:.0f} s, around people and animals", e.local_s)});
    report.tiles.push_back({"Near-collisions", fmt::format("{}", e.near_collisions), "",
                            fmt::format("{} by the vehicle; {} collisions, {} by the vehicle",
                                        e.robot_near, e.collisions, e.robot_collisions)});
    report.tiles.push_back({"Protective stops", fmt::format("{}", e.protective_stops), "",
                            fmt::format("held back for {:.0f} s", e.held_s)});
  }
  add_plan_tiles(planned, report);
  for (std::size_t v = 0; v < run.vehicles.size(); ++v) {
    report.vehicles[v].series = driven_series(run.vehicles[v]);
    report.vehicles[v].outline = planned.plan.vehicles[v].vehicle.footprint;
    report.vehicles[v].stops = charge_stops(planned.plan.vehicles[v], &run.vehicles[v]);
  }
  return report;
}

Report study_report(const FinishedStudy& study) {
  const StudyResult& result = study.result;
  Report report;
  report.title = "Study " + result.study;
  report.kind = ReportKind::kStudy;
  report.status = "completed";
  report.version = study.stamp.version;
  report.seed = study.stamp.seed;
  report.config_hash = study.stamp.config_hash;
  report.config_yaml = study.stamp.config_yaml;
  for (const StudyTable& table : result.tables) {
    ReportTable shown{table.title, {}, {}};
    for (const std::string& name : table.header) shown.columns.push_back({name});
    for (const auto& row : table.rows) shown.rows.emplace_back(row.begin(), row.end());
    report.tables.push_back(std::move(shown));
  }
  ReportTable cells{"Cells", {{"cell"}, {"n"}, {"metric"}, {"mean"}, {"95 % from"}, {"to"}}, {}};
  for (const StudyCell& cell : result.cells) {
    for (const auto& [metric, s] : cell.metrics) {
      if (static_cast<int>(cells.rows.size()) >= kMostCells) break;
      const auto bound = [](const std::optional<double>& value) -> ReportValue {
        return value ? ReportValue(*value) : ReportValue(std::string());
      };
      cells.rows.push_back({cell.name, static_cast<double>(cell.n), metric, s.mean, bound(s.ci_low),
                            bound(s.ci_high)});
    }
  }
  report.tables.push_back(std::move(cells));
  for (const Plot& plot : result.plots) {
    ReportPlot shown{plot.title, plot.x_label, plot.y_label, false, {}};
    for (const PlotSeries& series : plot.series) {
      shown.series.push_back({series.name, series.x, series.y, false});
    }
    report.plots.push_back(std::move(shown));
  }
  for (const Film& film : result.films) report.episodes.push_back(film_episode(film));
  return report;
}

}  // namespace headland::apps
