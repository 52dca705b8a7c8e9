// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/tracking_study.hpp"

#include <algorithm>
#include <functional>
#include <memory>

#include <fmt/format.h>

#include "control/drivable.hpp"
#include "sim/lab/parallel.hpp"
#include "sim/lab/statistics.hpp"
#include "sim/lab/tracking/drive.hpp"
#include "sim/lab/tracking/seed_follower.hpp"

namespace headland {
namespace {

struct Cell {
  StudyTracker tracker;
  StudyEstimator estimator;
  StudySlip slip;
  double speed;

  std::string name() const {
    return fmt::format("{}/{}/{}/{}", config::enum_name(tracker), config::enum_name(estimator),
                       config::enum_name(slip), speed);
  }
};

class Study {
 public:
  explicit Study(const TrackingStudyConfig& config) : config_(config) {
    for (const StudyTracker tracker : config.trackers) {
      for (const StudyEstimator estimator : config.estimators) {
        for (const StudySlip slip : config.slips) {
          for (const double speed : config.speeds_mps) {
            cells_.push_back({tracker, estimator, slip, speed});
          }
        }
      }
    }
  }

  StudyResult run(int jobs) {
    std::vector<std::pair<int, int>> drives;  // cell, run
    runs_.resize(cells_.size());
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const bool slow = cells_[c].tracker == StudyTracker::kRhmcIpopt;
      const int runs =
          slow ? std::min(config_.ipopt_runs_count, config_.runs_count) : config_.runs_count;
      runs_[c].resize(static_cast<std::size_t>(runs));
      for (int run = 0; run < runs; ++run) drives.emplace_back(static_cast<int>(c), run);
    }
    parallel_for(static_cast<int>(drives.size()), jobs, [&](int i) {
      const auto [cell, number] = drives[static_cast<std::size_t>(i)];
      runs_[static_cast<std::size_t>(cell)][static_cast<std::size_t>(number)] =
          drive(cells_[static_cast<std::size_t>(cell)], number);
    });
    StudyResult result{config_.study};
    for (std::size_t c = 0; c < cells_.size(); ++c) result.cells.push_back(summary(c));
    add_tables(result);
    add_plots(result);
    return result;
  }

 private:
  ControlConfig control_for(const Cell& cell) const {
    ControlConfig control = config_.control;
    control.estimator = EstimatorKind::kRhe;
    switch (cell.estimator) {
      case StudyEstimator::kNone:
        control.estimator = EstimatorKind::kSensors;
        break;
      case StudyEstimator::kEkf:
        control.estimator = EstimatorKind::kEkf;
        break;
      case StudyEstimator::kRheNone:
        control.rhe.blocking = NoiseBlocking::kNone;
        break;
      case StudyEstimator::kRheUniform:
        control.rhe.blocking = NoiseBlocking::kUniform;
        break;
      case StudyEstimator::kRheStructured:
        control.rhe.blocking = NoiseBlocking::kStructured;
        break;
    }
    switch (cell.tracker) {
      case StudyTracker::kSeedPurePursuit:
      case StudyTracker::kPurePursuit:
        control.tracker = TrackerKind::kPurePursuit;
        break;
      case StudyTracker::kRover:
        control.tracker = TrackerKind::kRover;
        break;
      case StudyTracker::kRhmcIpopt:
      case StudyTracker::kRhmcRti:
        control.tracker = TrackerKind::kRhmc;
        control.rhmc.solver = cell.tracker == StudyTracker::kRhmcRti ? HorizonSolverKind::kRti
                                                                     : HorizonSolverKind::kIpopt;
        break;
    }
    return control;
  }

  // Without an estimator the trackers are told the truth but for the slip.
  SimulatedVehicleConfig world_for(const Cell& cell, const TrackingCourse& course) const {
    SimulatedVehicleConfig world;
    world.sensors = config_.sensors;
    SlipConfig& slip = world.slip;
    if (cell.slip == StudySlip::kConstant) {
      slip.loss_ratio = config_.loss_ratio;
      slip.side_deg = config_.side_deg;
      slip.steering_offset_deg = config_.steering_offset_deg;
    } else if (cell.slip == StudySlip::kStepped) {
      slip.changes.push_back(
          {course.mid_turn_s, config_.loss_ratio, config_.side_deg, config_.steering_offset_deg});
    } else if (cell.slip == StudySlip::kCrossSlope) {
      slip.terrain_factor_ratio = 1.0;
    }
    return world;
  }

  // A plane that rises to the north, across the rows.
  Ground ground_for(const Cell& cell) const {
    if (cell.slip != StudySlip::kCrossSlope) return Ground();
    constexpr double kHalf = 2000.0;
    const double rise = config_.cross_slope_ratio * kHalf;
    return {Farm{},
            Terrain::from_grid({-kHalf, -kHalf}, 2.0 * kHalf, 2, 2, {-rise, -rise, rise, rise})};
  }

  TrackingDrive drive(const Cell& cell, int run) const {
    const bool seed = cell.tracker == StudyTracker::kSeedPurePursuit;
    const TrackingCourse course = tracking_course(config_.course, cell.speed, !seed);
    const ControlConfig control = control_for(cell);
    const std::unique_ptr<Tracker> tracker =
        seed ? std::make_unique<SeedFollower>(config_.vehicle, SeedPurePursuitConfig{})
             : make_tracker(config_.vehicle, control, {}, config_.cycle_s);
    const std::unique_ptr<Estimator> estimator =
        make_estimator(config_.vehicle, control, config_.cycle_s);
    return drive_course(config_.vehicle, course, *tracker, estimator.get(), world_for(cell, course),
                        ground_for(cell),
                        static_cast<std::uint64_t>(config_.seed) + static_cast<std::uint64_t>(run),
                        config_.cycle_s, config_.settle_m);
  }

  StudyCell summary(std::size_t c) const {
    const std::vector<TrackingDrive>& runs = runs_[c];
    StudyCell cell{cells_[c].name(), static_cast<int>(runs.size())};
    const auto add = [&](const char* metric,
                         const std::function<double(const TrackingDrive&)>& value) {
      std::vector<double> sample;
      sample.reserve(runs.size());
      for (const TrackingDrive& run : runs) sample.push_back(value(run));
      cell.metrics.emplace_back(metric, summarize(std::move(sample)));
    };
    // Of all ticks of all runs.
    const auto pool = [&](const char* metric, const std::vector<double> TrackingDrive::*ticks) {
      std::vector<double> all;
      for (const TrackingDrive& run : runs) {
        all.insert(all.end(), (run.*ticks).begin(), (run.*ticks).end());
      }
      Statistic statistic = summarize(all);
      statistic.p99 = quantile(std::move(all), 0.99);
      cell.metrics.emplace_back(metric, statistic);
    };
    const bool seed = cells_[c].tracker == StudyTracker::kSeedPurePursuit;
    const bool estimated = cells_[c].estimator != StudyEstimator::kNone;
    add("overall_rms_m", [](const TrackingDrive& d) { return d.tracking.overall_rms_m; });
    add("row_rms_m", [](const TrackingDrive& d) { return d.tracking.row_rms_m; });
    add("turn_rms_m", [](const TrackingDrive& d) { return d.tracking.turn_rms_m; });
    add("max_m", [](const TrackingDrive& d) { return d.tracking.max_m; });
    if (!seed) {
      add("fishtail_rms_m", [](const TrackingDrive& d) { return d.fishtail_rms_m; });
      add("cusp_max_m", [](const TrackingDrive& d) { return d.cusp_max_m; });
    }
    if (cells_[c].slip == StudySlip::kStepped) {
      add("recovery_s", [](const TrackingDrive& d) { return d.recovery_s; });
    }
    if (estimated) {
      add("loss_rmse_ratio", [](const TrackingDrive& d) { return d.loss_rmse_ratio; });
      add("side_rmse_deg", [](const TrackingDrive& d) { return d.side_rmse_deg; });
      add("offset_rmse_deg", [](const TrackingDrive& d) { return d.offset_rmse_deg; });
      add("position_rmse_m", [](const TrackingDrive& d) { return d.position_rmse_m; });
      add("speed_rmse_mps", [](const TrackingDrive& d) { return d.speed_rmse_mps; });
      pool("estimate_ms", &TrackingDrive::estimate_ms);
      add("estimate_p99_ms", [](const TrackingDrive& d) { return quantile(d.estimate_ms, 0.99); });
    }
    pool("solve_ms", &TrackingDrive::solve_ms);
    add("solve_p99_ms", [](const TrackingDrive& d) { return quantile(d.solve_ms, 0.99); });
    add("duration_s", [](const TrackingDrive& d) { return d.duration_s; });
    add("completed_ratio", [](const TrackingDrive& d) { return d.completed ? 1.0 : 0.0; });
    add("wrong_gear_count", [](const TrackingDrive& d) { return d.wrong_gear_count; });
    return cell;
  }

  // For each slip and speed: trackers down, estimators across.
  void add_tables(StudyResult& result) const {
    for (const StudySlip slip : config_.slips) {
      for (const double speed : config_.speeds_mps) {
        StudyTable table{fmt::format("RMS / largest cross-track error [mm], slip {}, {} m/s",
                                     config::enum_name(slip), speed),
                         {"tracker"},
                         {}};
        for (const StudyEstimator estimator : config_.estimators) {
          table.header.emplace_back(config::enum_name(estimator));
        }
        for (const StudyTracker tracker : config_.trackers) {
          std::vector<std::string> row{std::string(config::enum_name(tracker))};
          for (const StudyEstimator estimator : config_.estimators) {
            const StudyCell* cell = result.find(Cell{tracker, estimator, slip, speed}.name());
            row.push_back(fmt::format("{:.1f} / {:.0f}{}", 1e3 * cell->find("overall_rms_m")->mean,
                                      1e3 * cell->find("max_m")->mean,
                                      cell->find("completed_ratio")->mean < 1.0 ? " !" : ""));
          }
          table.rows.push_back(std::move(row));
        }
        result.tables.push_back(std::move(table));
      }
    }
  }

  // For each slip at the middle speed: the first run's error along the course, by tracker with the
  // last estimator, and by estimator with the last tracker.
  void add_plots(StudyResult& result) const {
    const double speed = config_.speeds_mps[config_.speeds_mps.size() / 2];
    for (const StudySlip slip : config_.slips) {
      Plot plot{fmt::format("Cross-track error, slip {}, {} m/s", config::enum_name(slip), speed),
                "way [m]", "cross-track error [m]"};
      for (std::size_t c = 0; c < cells_.size(); ++c) {
        const Cell& cell = cells_[c];
        if (cell.slip != slip || cell.speed != speed) continue;
        const bool last_tracker = cell.tracker == config_.trackers.back();
        if (!last_tracker && cell.estimator != config_.estimators.back()) continue;
        PlotSeries series{fmt::format("{}, {}", config::enum_name(cell.tracker),
                                      config::enum_name(cell.estimator))};
        for (const PathError& error : runs_[c].front().errors) {
          series.x.push_back(error.s);
          series.y.push_back(error.lateral_m);
        }
        plot.series.push_back(std::move(series));
      }
      result.plots.push_back(std::move(plot));
    }
  }

  const TrackingStudyConfig& config_;
  std::vector<Cell> cells_;
  std::vector<std::vector<TrackingDrive>> runs_;  // of every cell
};

}  // namespace

std::optional<Error> TrackingStudyConfig::check() const {
  const auto missing = [](const char* key) {
    return Error{ErrorCode::kMissingKey,
                 fmt::format("{} names none", key),
                 "name at least one",
                 {{}, 0, key}};
  };
  if (trackers.empty()) return missing("trackers");
  if (estimators.empty()) return missing("estimators");
  if (slips.empty()) return missing("slips");
  if (speeds_mps.empty()) return missing("speeds_mps");
  return std::nullopt;
}

Result<StudyResult> run_tracking_study(const TrackingStudyConfig& config, int jobs) {
  const TrackingCourse course = tracking_course(config.course, 1.0, true);
  if (auto error = check_curvature(config.vehicle, course.reference.path,
                                   config.vehicle.max_steering_rad())) {
    return tl::unexpected<Error>(std::move(*error));
  }
  return Study(config).run(jobs);
}

}  // namespace headland
