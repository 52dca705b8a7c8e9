// SPDX-License-Identifier: Apache-2.0
#include "apps/run_output.hpp"

#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/plan_output.hpp"

namespace headland::apps {

namespace {

nlohmann::ordered_json encounters(const EncounterMetrics& e) {
  nlohmann::ordered_json json = {{"takeovers", e.takeovers},
                                 {"local_s", e.local_s},
                                 {"held_s", e.held_s},
                                 {"protective_stops", e.protective_stops},
                                 {"near_collisions", e.near_collisions},
                                 {"robot_near_collisions", e.robot_near},
                                 {"collisions", e.collisions},
                                 {"robot_collisions", e.robot_collisions},
                                 {"least_gap_m", nullptr}};
  if (e.least_gap_m < kNobodyNear) json["least_gap_m"] = e.least_gap_m;
  return json;
}

nlohmann::ordered_json rows_seen(const RowSightMetrics& seen) {
  return {{"scans", seen.scans},
          {"valid_ratio", seen.valid_ratio()},
          {"mae_m", seen.mae_m()},
          {"max_m", seen.largest_m},
          {"blind_m", seen.blind_m}};
}

// A line of text, if rows were driven by what the lidar saw.
std::string rows_seen_text(const RowSightMetrics& seen) {
  if (seen.scans == 0) return "";
  return fmt::format(
      "rows seen  in {:.1f} % of {} scans; {:.3f} m off in the mean, {:.3f} m at most; blind for "
      "{:.1f} m at most\n",
      100.0 * seen.valid_ratio(), seen.scans, seen.mae_m(), seen.largest_m, seen.blind_m);
}

// A line of text, if anybody was about.
std::string encounter_text(const FleetRun& run) {
  if (run.agents.empty()) return "";
  const EncounterMetrics& e = run.metrics.encounters;
  return fmt::format(
      "agents     {} about; path left {} times for {:.0f} s, held back for {:.0f} s, {} protective "
      "stops\n"
      "           {} near-collisions ({} by the vehicle), {} collisions ({}), nearest {}\n",
      run.agents.front().agents.size(), e.takeovers, e.local_s, e.held_s, e.protective_stops,
      e.near_collisions, e.robot_near, e.collisions, e.robot_collisions,
      e.least_gap_m < kNobodyNear ? fmt::format("{:.2f} m", e.least_gap_m) : "nobody");
}

}  // namespace

std::string metrics_json(const FleetRun& run, const std::vector<VehiclePlan>& plans,
                         double real_time_factor, const Stamp& stamp) {
  const RunMetrics& m = run.metrics;
  const TrackingMetrics& t = m.tracking;
  nlohmann::ordered_json vehicles = nlohmann::ordered_json::array();
  for (std::size_t v = 0; v < run.vehicles.size(); ++v) {
    const RunMetrics& one = run.vehicles[v].metrics;
    vehicles.push_back({{"id", plans[v].id},
                        {"completed", one.completed},
                        {"rows_done", one.rows_done},
                        {"rows_total", one.rows_total},
                        {"charges", one.charges},
                        {"energy_j", one.energy_j},
                        {"duration_s", one.duration_s},
                        {"waited_s", one.waited_s},
                        {"min_soc", one.min_soc},
                        {"overall_rms_m", one.tracking.overall_rms_m},
                        {"replans", one.replans},
                        {"encounters", encounters(one.encounters)}});
  }
  nlohmann::ordered_json document = {{"completed", m.completed},
                                     {"reason", m.reason},
                                     {"rows_done", m.rows_done},
                                     {"rows_total", m.rows_total},
                                     {"visits_done", m.visits_done},
                                     {"visits_total", m.visits_total},
                                     {"charges", m.charges},
                                     {"tracking",
                                      {{"row_rms_m", t.row_rms_m},
                                       {"turn_rms_m", t.turn_rms_m},
                                       {"overall_rms_m", t.overall_rms_m},
                                       {"max_m", t.max_m},
                                       {"atd_m", t.atd_m},
                                       {"oscillation_count", t.oscillation_count},
                                       {"ra_1pm", t.ra_1pm}}},
                                     {"energy_j", m.energy_j},
                                     {"duration_s", m.duration_s},
                                     {"waited_s", m.waited_s},
                                     {"min_soc", m.min_soc},
                                     {"reserve_kept", m.reserve_kept},
                                     {"wrong_gear_count", m.wrong_gear_count},
                                     {"stale_plan_count", m.stale_plan_count},
                                     {"real_time_factor", real_time_factor},
                                     {"collisions", m.encounters.collisions},
                                     {"near_collisions", m.encounters.near_collisions},
                                     {"protective_stops", m.encounters.protective_stops},
                                     {"replans", m.replans},
                                     {"failed_replans", m.failed_replans},
                                     {"encounters", encounters(m.encounters)},
                                     {"rows_seen", rows_seen(m.rows_seen)},
                                     {"vehicles", vehicles},
                                     {"headland",
                                      {{"version", stamp.version},
                                       {"seed", stamp.seed},
                                       {"config_hash", stamp.config_hash},
                                       {"config_yaml", stamp.config_yaml}}}};
  return document.dump(2) + "\n";
}

std::string trace_csv(const FleetRun& run, const std::vector<VehiclePlan>& plans, double period) {
  std::string text =
      "t_s,vehicle,x_m,y_m,yaw_rad,speed_mps,steering_rad,yaw_rate_radps,s_m,cross_track_m,soc,"
      "gear,leg,loss_ratio,side_rad,steering_offset_rad,known_loss_ratio,known_side_rad,"
      "known_steering_offset_rad,position_error_m,driving\n";
  auto out = std::back_inserter(text);
  for (const FleetTick& at : fleet_ticks(run, period)) {
    const TraceRow& row = run.vehicles[at.vehicle].trace[at.tick];
    fmt::format_to(out, "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.t_s,
                   plans[at.vehicle].id, row.x_m, row.y_m, row.yaw_rad, row.speed_mps,
                   row.steering_rad, row.yaw_rate_radps, row.s_m, row.cross_track_m, row.soc,
                   static_cast<int>(row.gear), row.leg, row.slip.loss_ratio, row.slip.side_rad,
                   row.slip.steering_offset_rad, row.known_slip.loss_ratio, row.known_slip.side_rad,
                   row.known_slip.steering_offset_rad, row.position_error_m,
                   config::enum_name(row.driving));
  }
  return text;
}

std::string run_text(const FleetRun& run, double real_time_factor) {
  const RunMetrics& m = run.metrics;
  return fmt::format(
      "run        {}{}\n"
      "rows done  {} of {}{}\n"
      "tracking   {:.1f} mm RMS in rows, {:.1f} mm in turns, at most {:.1f} mm\n"
      "energy     {:.2f} kWh drawn, lowest state of charge {:.1f} %\n"
      "{}"
      "duration   {} simulated, {:.0f} times real time\n",
      m.completed ? "finished" : "NOT finished: ", m.reason, m.rows_done, m.rows_total,
      m.visits_total > 0 ? fmt::format(", visits {} of {}", m.visits_done, m.visits_total) : "",
      1e3 * m.tracking.row_rms_m, 1e3 * m.tracking.turn_rms_m, 1e3 * m.tracking.max_m,
      m.energy_j / 3.6e6, 100.0 * m.min_soc, encounter_text(run) + rows_seen_text(m.rows_seen),
      duration_text(m.duration_s), real_time_factor);
}

}  // namespace headland::apps
