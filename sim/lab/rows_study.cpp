// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/rows_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "global_planner/mission/mission_config.hpp"
#include "perception/cloud/cloud_file.hpp"
#include "sim/lab/parallel.hpp"
#include "sim/lab/statistics.hpp"

namespace headland {
namespace {

constexpr std::array kModes = {RowMode::kJoint, RowMode::kPublished};

// Both detectors in one scene.
struct Run {
  std::vector<RowDrive> wander;
  std::vector<RowDrive> closed;
};

double mean_magnitude(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += std::abs(value);
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

double deviation(const std::vector<double>& values) {
  double sum = 0.0;
  double squares = 0.0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const auto n = static_cast<double>(std::max<std::size_t>(values.size(), 1));
  return std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n)));
}

double ratio(int part, int whole) { return whole > 0 ? static_cast<double>(part) / whole : 0.0; }

Result<std::vector<CanopyStrip>> read_strips(const ScannedPlants& scan,
                                             const std::filesystem::path& folder) {
  const auto cloud = load_cloud(resolve_path(scan.file, folder));
  if (!cloud) return tl::unexpected<Error>(cloud.error());
  std::vector<Eigen::Vector3f> points;
  for (const LidarPoint& point : cloud->points) points.push_back(point.position);
  std::vector<CanopyStrip> strips;
  for (const double offset : scan.offsets_m) {
    strips.push_back(cut_strip(points, deg_to_rad(scan.heading_deg), offset, scan.half_width_m));
    if (strips.back().empty()) {
      return fail(ErrorCode::kOutOfRange, fmt::format("no plant of {} lies there", scan.file),
                  "offsets_m are the scanned rows' places", {{}, 0, "scan.offsets_m"});
    }
  }
  return strips;
}

Run run_scene(const RowsStudyConfig& config, const RowScenario& scenario,
              const std::vector<CanopyStrip>& strips, int number) {
  const auto seed = static_cast<std::uint64_t>(config.seed) + static_cast<std::uint64_t>(number);
  const LidarScene scene = scenario.scan
                               ? LidarScene::tiled(scenario.layout, strips, scenario.plants, seed)
                               : LidarScene::rows(scenario.layout, scenario.plants, seed);
  std::vector<RowDetectorConfig> detectors;
  for (const RowMode mode : kModes) {
    RowDetectorConfig detector = config.detector;
    detector.mode = mode;
    detector.row_width_m = scenario.layout.spacing_m;
    detector.sensor_x_m = config.mount.x_m;
    detector.sensor_y_m = config.mount.y_m;
    detector.sensor_z_m = config.mount.z_m;
    detectors.push_back(detector);
  }
  Run run;
  run.wander = wander_through(scene, scenario.layout, config.lidar, config.mount, config.drive,
                              detectors, seed);
  for (const RowDetectorConfig& detector : detectors) {
    run.closed.push_back(follow_lane(scene, scenario.layout, config.lidar, config.mount,
                                     config.drive, detector, seed));
  }
  return run;
}

StudyCell summary(const RowScenario& scenario, std::size_t mode, const std::vector<Run>& runs) {
  StudyCell cell{scenario.name, static_cast<int>(runs.size())};
  if (kModes[mode] == RowMode::kPublished) cell.name += "/published";
  // Runs without a value (no lane seen, no end) are left out.
  const auto add = [&](const char* metric, auto has_value, auto value) {
    std::vector<double> sample;
    for (const Run& run : runs) {
      if (has_value(run.wander[mode])) sample.push_back(value(run.wander[mode], run.closed[mode]));
    }
    if (!sample.empty()) cell.metrics.emplace_back(metric, summarize(std::move(sample)));
  };
  using D = const RowDrive&;
  const auto saw = [](D d) { return !d.errors_m.empty(); };
  const auto any = [](D) { return true; };
  const auto ends = [](D d) { return !d.end_errors_m.empty(); };
  add("mae_m", saw, [](D d, D) { return mean_magnitude(d.errors_m); });
  add("max_m", saw, [](D d, D) { return largest(d.errors_m); });
  add("std_m", saw, [](D d, D) { return deviation(d.errors_m); });
  add("heading_rms_deg", saw, [](D d, D) {
    double squares = 0.0;
    for (const double error : d.headings_rad) squares += error * error;
    return rad_to_deg(std::sqrt(squares / static_cast<double>(d.headings_rad.size())));
  });
  add("coverage_ratio", any,
      [](D d, D) { return ratio(static_cast<int>(d.errors_m.size()), d.lane_scans); });
  add("false_ratio", any, [](D d, D) { return ratio(d.false_lanes, d.headland_scans); });
  add("lateral_mae_m", any, [](D, D c) { return mean_magnitude(c.differences_m); });
  add("lateral_std_m", any, [](D, D c) { return deviation(c.differences_m); });
  add("driven_ratio", any, [](D, D c) { return c.driven_ratio; });
  add("row_end_error_m", ends, [](D d, D) { return mean_magnitude(d.end_errors_m); });
  add("row_end_max_m", ends, [](D d, D) { return largest(d.end_errors_m); });
  add("row_end_first_m", ends, [](D d, D) { return d.end_first_m; });
  std::vector<double> times;
  for (const Run& run : runs) {
    const auto& own = run.wander[mode].scan_ms;
    times.insert(times.end(), own.begin(), own.end());
  }
  Statistic time = summarize(times);
  time.p99 = quantile(std::move(times), 0.99);
  cell.metrics.emplace_back("scan_ms", time);
  return cell;
}

std::string shown(const StudyCell& cell, const char* metric) {
  const Statistic* value = cell.find(metric);
  return value != nullptr ? fmt::format("{:.4f}", value->mean) : "-";
}

StudyTable table_of(const StudyResult& result) {
  StudyTable table{"Centre line while wandering, and closed loop (seed 000, Tables I and II)",
                   {"scene", "MAE [m]", "max [m]", "std [m]", "coverage", "false",
                    "lateral MAE [m]", "end first [m]", "end error [m]"},
                   {}};
  for (const StudyCell& cell : result.cells) {
    std::vector<std::string> row{cell.name};
    for (const char* metric : {"mae_m", "max_m", "std_m", "coverage_ratio", "false_ratio",
                               "lateral_mae_m", "row_end_first_m", "row_end_error_m"}) {
      row.push_back(shown(cell, metric));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Plot plot_of(const RowScenario& scenario, const Run& run) {
  Plot plot{fmt::format("Error of the centre line, {}", scenario.name), "way [m]", "error [m]"};
  for (std::size_t mode = 0; mode < kModes.size(); ++mode) {
    plot.series.push_back({std::string(config::enum_name(kModes[mode])), run.wander[mode].way_m,
                           run.wander[mode].errors_m});
  }
  return plot;
}

}  // namespace

std::optional<Error> RowsStudyConfig::check() const {
  if (scenes.empty()) {
    return Error{
        ErrorCode::kMissingKey, "scenes names none", "name at least one", {{}, 0, "scenes"}};
  }
  for (const RowScenario& scene : scenes) {
    if (auto error = scene.plants.check()) return error;
    if (scene.scan && scene.scan->offsets_m.empty()) {
      return Error{ErrorCode::kMissingKey,
                   "scan.offsets_m names no row of the scan",
                   "name at least one",
                   {{}, 0, "scan.offsets_m"}};
    }
    if (scene.layout.rows_count < 2 || scene.layout.rows_count % 2 != 0) {
      return Error{ErrorCode::kOutOfRange,
                   "rows_count is no even number of rows",
                   "2, 4, 6, ...: the robot drives in the middle lane",
                   {{}, 0, "rows_count"}};
    }
  }
  return std::nullopt;
}

Result<StudyResult> run_rows_study(const RowsStudyConfig& config,
                                   const std::filesystem::path& folder, int jobs) {
  if (auto error = config.check()) return tl::unexpected<Error>(std::move(*error));
  const auto scenes = config.scenes.size();
  std::vector<std::vector<CanopyStrip>> strips(scenes);
  for (std::size_t scene = 0; scene < scenes; ++scene) {
    if (!config.scenes[scene].scan) continue;
    auto read = read_strips(*config.scenes[scene].scan, folder);
    if (!read) return tl::unexpected<Error>(std::move(read.error()));
    strips[scene] = std::move(*read);
  }
  std::vector<std::vector<Run>> runs(scenes,
                                     std::vector<Run>(static_cast<std::size_t>(config.runs_count)));
  parallel_for(static_cast<int>(scenes) * config.runs_count, jobs, [&](int i) {
    const auto scene = static_cast<std::size_t>(i / config.runs_count);
    const int number = i % config.runs_count;
    runs[scene][static_cast<std::size_t>(number)] =
        run_scene(config, config.scenes[scene], strips[scene], number);
  });
  StudyResult result{config.study};
  for (std::size_t scene = 0; scene < scenes; ++scene) {
    for (std::size_t mode = 0; mode < kModes.size(); ++mode) {
      result.cells.push_back(summary(config.scenes[scene], mode, runs[scene]));
    }
    result.plots.push_back(plot_of(config.scenes[scene], runs[scene].front()));
  }
  result.tables.push_back(table_of(result));
  return result;
}

}  // namespace headland
