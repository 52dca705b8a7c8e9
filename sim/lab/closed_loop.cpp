// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

namespace headland {
namespace {

constexpr double kProgressPeriod = 1.0;  // simulated [s]

// Window of the path in which the true position is projected, around the tracker's progress [m].
constexpr double kWindow = 3.0;
// Nearer to a cusp than this, the vehicle is on it [m].
constexpr double kOnCusp = 1e-6;

class Driver {
 public:
  Driver(const VehiclePlan& plan, const Farm& farm, const SimulationConfig& config,
         const Progress& progress)
      : plan_(plan),
        farm_(farm),
        config_(config),
        progress_(progress),
        vehicle_(plan.vehicle, plan.stages.front().path.start_pose(), plan.start_soc,
                 config.sensors, config.seed),
        tracker_(make_tracker(plan.vehicle, config.control, config.sensors)),
        worst_(plan.legs.size(), 0.0) {
    run_.leg_done.assign(plan.legs.size(), false);
    for (const PlanStage& stage : plan.stages) total_length_ += stage.path.length();
    for (const PlanLeg& leg : plan.legs) leg_speed_.push_back(leg_speed(plan.vehicle, leg.kind));
  }

  Run drive() {
    for (const PlanStage& stage : plan_.stages) {
      if (!drive_stage(stage)) break;
      if (stage.charge_leg >= 0) charge(stage.charge_leg);
      stage_start_s_ += stage.path.length();
    }
    summarise();
    return std::move(run_);
  }

 private:
  // False when the run has to be given up; the reason is in the metrics then.
  bool drive_stage(const PlanStage& stage) {
    const Reference reference{stage.path, leg_speed_};
    tracker_->start(reference);
    const double dt = config_.step_s;
    // Nothing drives a stage at less than a tenth of its planned pace.
    const double patience = 60.0 + 10.0 * planned_duration(stage);
    for (double elapsed = 0.0; elapsed < patience; elapsed += dt) {
      const TrackOutput output = tracker_->step(vehicle_.measure(), dt);
      if (output.status == TrackStatus::kDone && std::abs(vehicle_.truth().speed) < 1e-9) {
        return true;
      }
      if (output.status == TrackStatus::kPathLost) return give_up("the tracker lost the path");
      const auto leg = static_cast<std::size_t>(stage.path.at(output.s).leg);
      vehicle_.step(output.command, plan_.legs[leg].kind, dt);
      ++ticks_;
      time_ = charged_s_ + static_cast<double>(ticks_) * dt;
      record(stage.path, output);
      if (std::abs(run_.trace.back().cross_track_m) > config_.max_deviation_m) {
        return give_up("the vehicle left its path");
      }
      if (vehicle_.soc() <= 0.0) return give_up("the battery is empty");
    }
    return give_up("the vehicle does not get on");
  }

  double planned_duration(const PlanStage& stage) const {
    double duration = 0.0;
    for (const PathPiece& piece : stage.path.pieces()) {
      duration += piece.length / leg_speed_[static_cast<std::size_t>(piece.leg)];
    }
    return duration + 10.0 * static_cast<double>(stage.path.segments().size());
  }

  // Projects the true position onto the path around the tracker's progress, never across a cusp
  // (the path runs back on itself there), and appends a trace row.
  void record(const Path& path, const TrackOutput& output) {
    const VehicleState& truth = vehicle_.truth();
    // On a cusp the tracker is still on the segment that ends there.
    const double s = std::max(0.0, output.s - kOnCusp);
    const PathSegment& segment = path.segments()[static_cast<std::size_t>(path.at(s).segment)];
    const Projection projection =
        path.project(truth.pose.position(), std::max(segment.begin_s, output.s - kWindow),
                     std::min(segment.end_s, output.s + kWindow));
    const PathSample at = path.at(std::min(projection.s, segment.end_s - 1e-9));
    run_.trace.push_back({time_, truth.pose.x, truth.pose.y, truth.pose.yaw, truth.speed,
                          truth.steering, output.command.yaw_rate, stage_start_s_ + projection.s,
                          projection.lateral_error, vehicle_.soc(), at.gear, at.leg});
    const auto leg = static_cast<std::size_t>(at.leg);
    worst_[leg] = std::max(worst_[leg], std::abs(projection.lateral_error));
    run_.leg_done[leg] = true;
    if (truth.speed * sign(at.gear) < -1e-3) ++run_.metrics.wrong_gear_count;
    run_.metrics.min_soc = std::min(run_.metrics.min_soc, vehicle_.soc());
    if (progress_ && time_ >= next_progress_) {
      next_progress_ += kProgressPeriod;
      progress_((stage_start_s_ + projection.s) / total_length_, time_);
    }
  }

  bool give_up(const char* why) {
    const bool moved = !run_.trace.empty();
    const int leg = moved ? run_.trace.back().leg : 0;
    run_.metrics.reason =
        fmt::format("{} after {:.1f} m, on leg '{}'", why, moved ? run_.trace.back().s_m : 0.0,
                    plan_.legs[static_cast<std::size_t>(leg)].id);
    return false;
  }

  void charge(int leg) {
    for (const Charger& charger : farm_.chargers) {
      if (charger.id == plan_.legs[static_cast<std::size_t>(leg)].id) {
        charged_s_ += vehicle_.charge_full(charger.curve.max_power());
        time_ = charged_s_ + static_cast<double>(ticks_) * config_.step_s;
      }
    }
    run_.leg_done[static_cast<std::size_t>(leg)] = true;
  }

  void summarise() {
    RunMetrics& metrics = run_.metrics;
    for (std::size_t i = 0; i < plan_.legs.size(); ++i) {
      if (plan_.legs[i].kind != LegKind::kRow) continue;
      ++metrics.rows_total;
      // The last row begun when a run breaks off was not driven to its end.
      const bool broken_off = !metrics.reason.empty() && !run_.trace.empty() &&
                              run_.trace.back().leg == static_cast<int>(i);
      run_.leg_done[i] = run_.leg_done[i] && !broken_off && worst_[i] <= config_.row_tolerance_m;
      metrics.rows_done += run_.leg_done[i] ? 1 : 0;
    }
    const double reserve = plan_.vehicle.battery.reserve_soc;
    metrics.reserve_kept = metrics.min_soc >= reserve - 1e-9;
    if (metrics.reason.empty() && !metrics.reserve_kept) {
      metrics.reason = fmt::format("the charge fell to {:.1f} %, below the reserve of {:.1f} %",
                                   100.0 * metrics.min_soc, 100.0 * reserve);
    }
    metrics.completed = metrics.reason.empty() && metrics.rows_done == metrics.rows_total;
    if (metrics.reason.empty() && !metrics.completed) {
      metrics.reason = fmt::format("{} rows were driven with an error above {} m",
                                   metrics.rows_total - metrics.rows_done, config_.row_tolerance_m);
    }
    metrics.energy_j = vehicle_.drawn_j();
    metrics.duration_s = time_;
    add_tracking();
  }

  void add_tracking() {
    std::vector<PathError> errors;
    errors.reserve(run_.trace.size());
    for (const TraceRow& row : run_.trace) {
      errors.push_back({row.s_m, row.cross_track_m, std::abs(row.cross_track_m), row.leg});
    }
    std::vector<LegKind> kinds;
    for (const PlanLeg& leg : plan_.legs) kinds.push_back(leg.kind);
    run_.metrics.tracking = tracking_metrics(errors, kinds);
  }

  const VehiclePlan& plan_;
  const Farm& farm_;
  const SimulationConfig& config_;
  const Progress& progress_;
  SimulatedVehicle vehicle_;
  std::unique_ptr<Tracker> tracker_;
  std::vector<double> leg_speed_;
  std::vector<double> worst_;  // largest cross-track error of each leg
  Run run_;
  long ticks_ = 0;
  double charged_s_ = 0.0;  // spent at chargers
  double time_ = 0.0;       // both
  double next_progress_ = 0.0;
  double stage_start_s_ = 0.0;
  double total_length_ = 0.0;
};

}  // namespace

std::vector<int> trace_ticks(const std::vector<TraceRow>& trace, double period) {
  std::vector<int> ticks;
  double next = 0.0;
  for (int i = 0; i < static_cast<int>(trace.size()); ++i) {
    const double t = trace[static_cast<std::size_t>(i)].t_s;
    if (i > 0 && i + 1 < static_cast<int>(trace.size()) && t < next) continue;
    ticks.push_back(i);
    next = t + period - 1e-9;
  }
  return ticks;
}

Run drive_plan(const VehiclePlan& plan, const Farm& farm, const SimulationConfig& config,
               const Progress& progress) {
  return Driver(plan, farm, config, progress).drive();
}

}  // namespace headland
