// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/ebs221/figures.hpp"

#include <fmt/format.h>

namespace headland {
namespace {

constexpr std::size_t kEvery = 20;  // of the control periods, for plots

std::string shown(const StudyResult& result, const std::string& cell, const std::string& metric) {
  const StudyCell* found = result.find(cell);
  const Statistic* value = found != nullptr ? found->find(metric) : nullptr;
  if (value == nullptr) return "-";
  if (!value->std) return fmt::format("{:.5f}", value->mean);
  return fmt::format("{:.5f} +- {:.5f}", value->mean, *value->std);
}

// overall / rows / turns
std::string triple(const StudyResult& result, const std::string& cell, const std::string& prefix) {
  if (shown(result, cell, prefix + "overall_rms_m") == "-") return "-";
  return shown(result, cell, prefix + "overall_rms_m") + " / " +
         shown(result, cell, prefix + "row_rms_m") + " / " +
         shown(result, cell, prefix + "turn_rms_m");
}

std::string published(const std::string& cell) {
  for (const PublishedDrive& p : kPublishedDrives) {
    if (cell != p.cell) continue;
    return fmt::format("{:.4f} / {:.4f} / {:.4f}", p.overall_rms_m, p.row_rms_m, p.turn_rms_m);
  }
  return "-";
}

}  // namespace

void add_drive_table(StudyResult& result) {
  StudyTable table;
  table.title = "Cross-track error, RMS [m]: all / rows / turns";
  table.header = {"drive", "(002)", "by the seed's rule", "to the exact path", "largest [m]"};
  for (const StudyCell& cell : result.cells) {
    if (cell.name.rfind("track/", 0) != 0) continue;
    table.rows.push_back({cell.name, published(cell.name), triple(result, cell.name, "seed_"),
                          triple(result, cell.name, "true_"), shown(result, cell.name, "max_m")});
  }
  result.tables.push_back(std::move(table));
}

void add_tour_table(StudyResult& result) {
  StudyTable table;
  table.title = "Row orders: turns and ways from and to the depot [m]; genetic algorithm of (002)";
  table.header = {"tour", "(002) [m]", "(002) [s]", "optimum here [m]", "here [s]", "proven"};
  for (const StudyCell& cell : result.cells) {
    if (cell.name.rfind("tour/", 0) != 0) continue;
    std::string cost = "-";
    std::string time = "-";
    for (const PublishedTour& p : kPublishedTours) {
      if (cell.name != p.cell) continue;
      cost = fmt::format("{:.4f}", p.cost_m);
      time = fmt::format("{:.2f}", p.planning_s);
    }
    table.rows.push_back({cell.name, cost, time, fmt::format("{:.5f}", cell.find("cost_m")->mean),
                          shown(result, cell.name, "planning_s"),
                          cell.find("optimal")->mean == 1.0 ? "yes" : "no"});
  }
  result.tables.push_back(std::move(table));
}

void add_drive_plots(const std::string& cell, const FieldDrive& drive, const Path& path,
                     StudyResult& result) {
  Plot way{cell + ": the drive", "x [m]", "y [m]", {{"path"}, {"driven"}}};
  Plot error{cell + ": distance to the path", "driven [m]", "error [m]", {{cell}}};
  Plot steering{cell + ": steering", "driven [m]", "steering [deg]", {{cell}}};
  for (const PathSample& sample : path.sample(0.5)) {
    way.series[0].x.push_back(sample.pose.x);
    way.series[0].y.push_back(sample.pose.y);
  }
  double driven = 0.0;
  for (std::size_t i = 0; i < drive.positions.size(); ++i) {
    if (i > 0) driven += (drive.positions[i] - drive.positions[i - 1]).norm();
    if (i % kEvery != 0) continue;
    way.series[1].x.push_back(drive.positions[i].x());
    way.series[1].y.push_back(drive.positions[i].y());
    error.series[0].x.push_back(driven);
    error.series[0].y.push_back(drive.errors[i].distance_m);
    steering.series[0].x.push_back(driven);
    steering.series[0].y.push_back(rad_to_deg(drive.steering[i]));
  }
  result.plots.push_back(std::move(way));
  result.plots.push_back(std::move(error));
  result.plots.push_back(std::move(steering));
}

}  // namespace headland
