// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/polito/figures.hpp"

#include <functional>

#include <fmt/format.h>

namespace headland {
namespace {

std::string grid_cell(double lookahead, double pitch) {
  return "grid/" + cell_key("LD", lookahead) + "/" + cell_key("WPP", pitch);
}

// One series per value of `outer`, over `inner`; `cell_of(outer, inner)` names the cell.
Plot grid_plot(const StudyResult& result, const std::string& metric, const std::string& outer_name,
               const std::vector<double>& outer, const std::vector<double>& inner,
               const std::function<std::string(double, double)>& cell_of) {
  Plot plot;
  for (const double o : outer) {
    PlotSeries series{outer_name + " " + fmt::format("{} m", o)};
    for (const double i : inner) {
      const StudyCell* cell = result.find(cell_of(o, i));
      const Statistic* value = cell != nullptr ? cell->find(metric) : nullptr;
      if (value == nullptr) continue;
      series.x.push_back(i);
      series.y.push_back(value->mean);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

// A cell's metric with its interval, for readers.
std::string shown(const StudyResult& result, const std::string& cell, const std::string& metric) {
  const StudyCell* found = result.find(cell);
  const Statistic* value = found != nullptr ? found->find(metric) : nullptr;
  if (value == nullptr) return "-";
  if (!value->ci_low) return fmt::format("{:.4g}", value->mean);
  return fmt::format("{:.4f} [{:.4f}, {:.4f}]", value->mean, *value->ci_low, *value->ci_high);
}

}  // namespace

std::string cell_key(const std::string& name, double value) {
  return fmt::format("{}_{}", name, value);
}

void add_grid_plots(const PolitoStudyConfig& config, StudyResult& result) {
  const auto& ld = config.grid_lookahead_m;
  const auto& wpp = config.grid_waypoint_pitch_m;
  const auto by_ld = [](double l, double p) { return grid_cell(l, p); };
  const auto by_wpp = [](double p, double l) { return grid_cell(l, p); };
  const auto add = [&result](Plot plot, const std::string& title, const std::string& x,
                             const std::string& y) {
    plot.title = title;
    plot.x_label = x;
    plot.y_label = y;
    result.plots.push_back(std::move(plot));
  };
  add(grid_plot(result, "atd_m", "LD", ld, wpp, by_ld), "ATD over WPP ((004) Fig. 15)", "WPP [m]",
      "ATD [m]");
  add(grid_plot(result, "oscillation_count", "LD", ld, wpp, by_ld), "OF over WPP ((004) Fig. 16)",
      "WPP [m]", "OF [peaks]");
  add(grid_plot(result, "ra_1pm", "LD", ld, wpp, by_ld), "RA over WPP ((004) Fig. 18)", "WPP [m]",
      "RA [1/m]");
  add(grid_plot(result, "ra_1pm", "WPP", wpp, ld, by_wpp), "RA over LD ((004) Fig. 18)", "LD [m]",
      "RA [1/m]");
}

void add_accuracy_table(const PolitoStudyConfig& config, StudyResult& result) {
  StudyTable table;
  table.title =
      "RA [1/m] by accuracy of the position fix: (004) Tables 2 and 3, its follower here, ours; "
      "mean and 95 % interval";
  table.header = {"accuracy [m]",         "(004)", "(004), 2.5 deg",      "seed here",
                  "seed here, threshold", "ours",  "ours, to exact path", "ours, waves >= 1 mm"};
  std::vector<double> accuracies = {0.0};
  accuracies.insert(accuracies.end(), config.accuracies_m.begin(), config.accuracies_m.end());
  for (const double accuracy : accuracies) {
    std::string printed = "-";
    std::string printed_threshold = "-";
    for (const PublishedAccuracy& p : kPublishedAccuracies) {
      if (p.accuracy_m != accuracy) continue;
      printed = fmt::format("{}", p.ra_1pm);
      printed_threshold = fmt::format("{}", p.ra_threshold_1pm);
    }
    const std::string noise = accuracy > 0.0 ? "/" + cell_key("noise", accuracy) : "";
    table.rows.push_back({fmt::format("{}", accuracy), printed, printed_threshold,
                          shown(result, "track/seed" + noise, "ra_1pm"),
                          shown(result, "track/seed" + noise + "/threshold", "ra_1pm"),
                          shown(result, "track/ours" + noise, "ra_1pm"),
                          shown(result, "track/ours" + noise, "exact_ra_1pm"),
                          shown(result, "track/ours" + noise, "wave_ra_1pm")});
  }
  result.tables.push_back(std::move(table));
}

void add_baseline_table(StudyResult& result) {
  StudyTable table;
  table.title = "Without position errors: (004) Fig. 20, its follower here, ours";
  table.header = {"", "(004)", "seed here", "ours"};
  const auto row = [&](const std::string& name, const std::string& printed,
                       const std::string& metric) {
    table.rows.push_back(
        {name, printed, shown(result, "track/seed", metric), shown(result, "track/ours", metric)});
  };
  row("RA [1/m]", "0.34", "ra_1pm");
  row("ATD [m]", "-", "atd_m");
  row("OF [peaks]", "-", "oscillation_count");
  row("largest deviation [m]", "-", "max_m");
  row("ATD to the exact path [m]", "-", "exact_atd_m");
  row("peaks >= 1 mm to the exact path", "-", "wave_count");
  result.tables.push_back(std::move(table));
}

PlotSeries hairpin_series(const std::string& name, const ParametricOrchardConfig& orchard,
                          const std::vector<Point2>& positions) {
  PlotSeries series{name};
  const double from_y = orchard.row_end() - 2.0;
  const double to_x = orchard.alley_x(1) + 0.5 * orchard.pitch();
  for (const Point2& p : positions) {
    if (p.y() < from_y || p.x() > to_x) continue;
    series.x.push_back(p.x());
    series.y.push_back(p.y());
  }
  return series;
}

}  // namespace headland
