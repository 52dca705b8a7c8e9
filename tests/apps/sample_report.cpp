// SPDX-License-Identifier: Apache-2.0
#include "tests/apps/sample_report.hpp"

#include <cmath>

#include <fmt/format.h>

#include "apps/report_terrain.hpp"
#include "core/base/random.hpp"
#include "core/geometry/angle.hpp"

namespace headland {
namespace {

constexpr double kRowLength = 120.0;
constexpr double kSpacing = 4.0;
constexpr double kTilt = 0.18;  // of the rows against north [rad]

Point2 tilted(double x, double y) {
  return {x * std::cos(kTilt) - y * std::sin(kTilt), x * std::sin(kTilt) + y * std::cos(kTilt)};
}

Polyline row_line(int row) {
  return {tilted(row * kSpacing, 0.0), tilted(row * kSpacing, kRowLength)};
}

// From the end of one row to the start of the next but `skip`: a half circle with a straight.
Polyline turn_line(int from, int to, bool at_top) {
  Polyline line;
  const double radius = 2.0 * kSpacing / 2.0;
  const double side = to > from ? 1.0 : -1.0;
  for (int i = 0; i <= 12; ++i) {
    const double angle = kPi * i / 12.0;
    const double half = std::abs(to - from) * kSpacing / 2.0;
    const double x = (from + to) * kSpacing / 2.0 - side * half * std::cos(angle);
    const double reach = radius * std::sin(angle);
    line.push_back(tilted(x, at_top ? kRowLength + reach : -reach));
  }
  return line;
}

void add_ground(Report& report, int rows) {
  const double width = (rows - 1) * kSpacing;
  const auto box = [&](double x0, double y0, double x1, double y1) {
    return Polygon{{tilted(x0, y0), tilted(x1, y0), tilted(x1, y1), tilted(x0, y1)}, {}};
  };
  auto& features = report.features;
  features.push_back(ReportFeature::polygon("headland", "Headland",
                                            box(-14.0, -12.0, width + 10.0, kRowLength + 12.0)));
  features.push_back(
      ReportFeature::polygon("parcel", "Parcel A", box(-2.0, -2.0, width + 2.0, kRowLength + 2.0)));
  features.push_back(
      ReportFeature::line("road", "Farm road", {tilted(-11.0, 130.0), tilted(-11.0, -40.0)}));
  features.push_back(
      ReportFeature::polygon("keep_out", "Pump house", box(-10.0, 55.0, -5.0, 61.0)));
  features.push_back(ReportFeature::point("gate", "South gate", tilted(-11.0, -12.0)));
  features.push_back(ReportFeature::point("poi", "Warehouse", tilted(-11.0, -40.0)));
  features.push_back(ReportFeature::point("charger", "Charger 1", tilted(-6.0, -34.0)));
}

struct Legs {
  std::vector<Polyline> lines;
  std::vector<std::string> kinds;
};

Legs make_legs(int rows) {
  Legs legs;
  const auto add = [&](Polyline line, const char* kind) {
    legs.lines.push_back(std::move(line));
    legs.kinds.emplace_back(kind);
  };
  add({tilted(-11.0, -40.0), tilted(-11.0, -8.0), tilted(-6.0, -4.0), tilted(0.0, 0.0)}, "transit");
  for (int i = 0; i < rows; ++i) {
    Polyline line = row_line(i);
    const bool up = i % 2 == 0;
    if (!up) std::swap(line.front(), line.back());
    add(std::move(line), "row");
    if (i + 1 < rows) add(turn_line(i, i + 1, up), "turn");
  }
  add({legs.lines.back().back(), tilted((rows - 1) * kSpacing, -8.0), tilted(0.0, -9.0),
       tilted(-6.0, -34.0)},
      "charge");
  return legs;
}

void add_legs(Report& report, const Legs& legs) {
  ReportTable table{.title = "Legs",
                    .columns = {{"leg"},
                                {"kind"},
                                {"id"},
                                {"length", "m"},
                                {"energy", "kJ"},
                                {"duration", "s"},
                                {"soc end", "%"}},
                    .rows = {}};
  double soc = 0.95;
  for (std::size_t i = 0; i < legs.lines.size(); ++i) {
    auto feature = ReportFeature::line("plan", {}, legs.lines[i]);
    feature.vehicle = 0;
    feature.leg = static_cast<int>(i);
    feature.leg_kind = legs.kinds[i];
    report.features.push_back(feature);
    const double metres = length(legs.lines[i]);
    const double joules = metres * (legs.kinds[i] == "row" ? 700.0 : 450.0);
    soc -= joules / 4.0e6;
    if (legs.kinds[i] == "row") {
      auto row = ReportFeature::line("row_done", fmt::format("R{}", i / 2 + 1), legs.lines[i]);
      report.features.push_back(row);
    }
    table.rows.push_back({static_cast<double>(i), legs.kinds[i], fmt::format("A/{}", i / 2 + 1),
                          metres, joules / 1000.0, metres / 1.4, 100.0 * soc});
  }
  report.tables.push_back(std::move(table));
}

void add_series(Report& report, const Legs& legs, int samples) {
  double total = 0.0;
  for (const Polyline& line : legs.lines) total += length(line);
  RandomStream random(7, "sample report");
  auto& series = report.vehicles.front().series;
  double s = 0.0;
  double error = 0.0;
  double soc = 0.95;
  const double step = total / samples;
  for (std::size_t leg = 0; leg < legs.lines.size(); ++leg) {
    const Polyline& line = legs.lines[leg];
    const bool turn = legs.kinds[leg] == "turn";
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Point2 along = line[i] - line[i - 1];
      const Point2 left = Point2(-along.y(), along.x()).normalized();
      for (double d = 0.0; d < along.norm(); d += step) {
        error += 0.02 * ((turn ? 0.14 : 0.0) - error) + 0.0025 * random.normal();
        soc -= step * (turn ? 450.0 : 700.0) / 4.0e6;
        const Point2 p = line[i - 1] + along * (d / along.norm()) + left * error;
        series.s_m.push_back(s);
        series.x_m.push_back(p.x());
        series.y_m.push_back(p.y());
        series.error_m.push_back(error);
        series.steering_deg.push_back((turn ? 24.0 : 0.0) - 40.0 * error);
        series.soc.push_back(soc);
        series.speed_mps.push_back((turn ? 1.0 : 1.5) + 0.01 * random.normal());
        series.leg.push_back(static_cast<int>(leg));
        s += step;
      }
    }
  }
}

// Works every third row from `first`, and charges whenever it comes down to 35 %.
void add_vehicle(Report& report, int first, int rows, double start_soc) {
  const int number = static_cast<int>(report.vehicles.size());
  ReportVehicle vehicle{.name = fmt::format("t{}", number + 1), .reserve_soc = 0.2};
  ReportTable& table = report.tables.front();
  double s = 0.0;
  double soc = start_soc;
  int leg = 0;
  const auto drive = [&](const Polyline& line, const char* kind, const std::string& id) {
    auto feature = ReportFeature::line("plan", id, line);
    feature.vehicle = number;
    feature.leg = leg;
    feature.leg_kind = kind;
    report.features.push_back(feature);
    const double per_metre = std::string(kind) == "row" ? 0.0006 : 0.0004;
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Point2 along = line[i] - line[i - 1];
      const int steps = std::max(1, static_cast<int>(along.norm()));
      for (int k = 0; k < steps; ++k) {
        const Point2 p = line[i - 1] + along * (static_cast<double>(k) / steps);
        vehicle.series.s_m.push_back(s);
        vehicle.series.x_m.push_back(p.x());
        vehicle.series.y_m.push_back(p.y());
        vehicle.series.soc.push_back(soc);
        vehicle.series.leg.push_back(leg);
        s += along.norm() / steps;
        soc -= per_metre * along.norm() / steps;
      }
    }
    table.rows.push_back({vehicle.name, static_cast<double>(leg++), kind, id, length(line),
                          length(line) / 1.4, 100.0 * soc});
  };
  const Point2 charger = tilted(-6.0, -34.0);
  Point2 at = charger;
  for (int row = first; row < rows; row += 3) {
    Polyline line = row_line(row);
    if ((row - first) / 3 % 2 == 1) std::swap(line.front(), line.back());
    if (soc < 0.35) {
      drive({at, charger}, "transit", "to Charger 1");
      vehicle.stops.push_back({s, soc, 0.9, "Charger 1"});
      report.why.push_back({number, leg,
                            fmt::format("charges here: row R{} and the way back would "
                                        "leave {:.0f} %, below the reserve of 20 %",
                                        row + 1, 100.0 * soc - 9.0)});
      table.rows.push_back(
          {vehicle.name, static_cast<double>(leg++), "charge", "Charger 1", 0.0, 1800.0, 90.0});
      soc = 0.9;
      at = charger;
    }
    drive({at, line.front()}, "transit", fmt::format("to R{}", row + 1));
    drive(line, "row", fmt::format("R{}", row + 1));
    at = line.back();
  }
  report.vehicles.push_back(std::move(vehicle));
}

}  // namespace

Report sample_fleet_report() {
  constexpr int kRows = 30;
  Report report;
  report.title = "Three tractors on a hill";
  report.status = "feasible";
  report.version = "0.1.0";
  report.seed = 1;
  report.tiles = {{"Vehicles", 3.0}, {"Rows", 30.0}, {"Left out", 1.0, "task"}};
  report.tables.push_back({.title = "Legs",
                           .columns = {{"vehicle"},
                                       {"leg"},
                                       {"kind"},
                                       {"name"},
                                       {"length", "m"},
                                       {"duration", "s"},
                                       {"charge at end", "%"}},
                           .rows = {}});
  add_ground(report, kRows);
  for (int row = 0; row < kRows; ++row) {
    report.features.push_back(
        ReportFeature::line("row", fmt::format("R{}", row + 1), row_line(row)));
  }
  for (int v = 0; v < 3; ++v) add_vehicle(report, v, kRows, 0.95 - 0.1 * v);
  report.why.push_back({-1, -1, "row R31 is left out: its way is steeper than 20 deg"});
  const Point2 corner(-60.0, -60.0);
  const Point2 other(180.0, 180.0);
  const Terrain hills = Terrain::hills({.seed = 3, .relief_m = 24.0}, corner, other);
  report.terrain = terrain_raster(Ground(Farm{}, hills), MapBox(corner, other));
  return report;
}

Report sample_report(int rows, int samples) {
  Report report;
  report.title = "Girona orchard, parcel A";
  report.kind = ReportKind::kRun;
  report.status = "completed";
  report.version = "0.1.0";
  report.seed = 7;
  report.config_hash = "9f3c27a1e04b5d68";
  report.config_yaml = "mission: girona\nobjective: energy\nvehicles:\n  - id: t1\n    soc: 0.95\n";
  report.vehicles = {{.name = "t1", .reserve_soc = 0.15}};
  report.tiles = {{"Rows done", fmt::format("{} / {}", rows, rows)},
                  {"Work", kRowLength * rows, "m"},
                  {"Turns", 214.6, "m"},
                  {"Transit", 96.4, "m"},
                  {"Energy", 2.141, "MJ", "lower bound 2.087 MJ"},
                  {"Gap", 2.6, "%", "to the proven bound"},
                  {"Duration", "34 min 12 s"},
                  {"Charge stops", 1.0},
                  {"Tracking RMS", 0.047, "m", "rows 0.021 m, turns 0.121 m"}};
  add_ground(report, rows);
  const Legs legs = make_legs(rows);
  add_legs(report, legs);
  add_series(report, legs, samples);
  ReportPlot plot{
      .title = "Planning time", .x_label = "rows", .y_label = "s", .log_y = true, .series = {}};
  for (const char* name : {"exact", "local search", "greedy"}) {
    ReportPlot::Series line{.name = name, .x = {}, .y = {}};
    const double rate = 0.9 - 0.3 * static_cast<double>(plot.series.size());
    for (int n = 4; n <= 16; ++n) {
      line.x.push_back(n);
      line.y.push_back(1e-4 * std::exp(rate * n));
    }
    plot.series.push_back(std::move(line));
  }
  plot.series.back().points = true;
  report.plots.push_back(std::move(plot));
  return report;
}

}  // namespace headland
