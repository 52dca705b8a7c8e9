// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/polito_study.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "sim/lab/metrics.hpp"
#include "sim/lab/polito/drive.hpp"
#include "sim/lab/polito/figures.hpp"
#include "sim/lab/statistics.hpp"

namespace headland {
namespace {

// One drive, measured by all rules.
struct Measured {
  RelativeAccuracy by_seed;  // deviation from the waypoints' polyline, every peak
  RelativeAccuracy exact;    // deviation from the exact path, every peak
  RelativeAccuracy wave;     // the same, peaks of 1 mm and more
  double max_m = 0.0;        // from the waypoints' polyline
  int samples = 0;
  bool completed = false;
};

Measured measure(const DrivenTrack& track, const Path& path, const std::vector<Point2>& waypoints) {
  Measured m;
  const std::vector<double> deviations = deviations_from_polyline(track.positions, waypoints);
  std::vector<double> exact;
  exact.reserve(track.positions.size());
  for (const PathError& e : errors_from_path(track.positions, path)) exact.push_back(e.distance_m);
  m.by_seed = relative_accuracy(deviations, kRoundingProminence);
  m.exact = relative_accuracy(exact, kRoundingProminence);
  m.wave = relative_accuracy(exact, kWaveProminence);
  for (const double d : deviations) m.max_m = std::max(m.max_m, d);
  m.samples = static_cast<int>(track.positions.size());
  m.completed = track.completed;
  return m;
}

StudyCell cell_of(const std::string& name, const std::vector<Measured>& runs) {
  StudyCell cell{name, static_cast<int>(runs.size())};
  const auto add = [&](const char* metric, const std::function<double(const Measured&)>& value) {
    std::vector<double> sample;
    sample.reserve(runs.size());
    for (const Measured& run : runs) sample.push_back(value(run));
    cell.metrics.emplace_back(metric, summarize(std::move(sample)));
  };
  add("atd_m", [](const Measured& m) { return m.by_seed.atd_m; });
  add("oscillation_count", [](const Measured& m) { return m.by_seed.oscillation_count; });
  add("ra_1pm", [](const Measured& m) { return m.by_seed.ra_1pm; });
  add("max_m", [](const Measured& m) { return m.max_m; });
  add("exact_atd_m", [](const Measured& m) { return m.exact.atd_m; });
  add("exact_oscillation_count", [](const Measured& m) { return m.exact.oscillation_count; });
  add("exact_ra_1pm", [](const Measured& m) { return m.exact.ra_1pm; });
  add("wave_count", [](const Measured& m) { return m.wave.oscillation_count; });
  add("wave_ra_1pm", [](const Measured& m) { return m.wave.ra_1pm; });
  add("samples_count", [](const Measured& m) { return m.samples; });
  add("completed_ratio", [](const Measured& m) { return m.completed ? 1.0 : 0.0; });
  return cell;
}

// What is the same for all cells, and the drives themselves.
class Study {
 public:
  Study(const PolitoStudyConfig& config, OrchardPath plan)
      : config_(config), plan_(std::move(plan)) {
    reference_.path = plan_.path;
    reference_.leg_speed.assign(plan_.legs.size(), config.speed_kmh / 3.6);
    vehicle_.steering = Steering::kDifferential;
    vehicle_.acceleration_mps2 = config.acceleration_mps2;
    waypoints_ = waypoints(plan_.path, config.waypoint_pitch_m);
  }

  StudyResult run() {
    result_.study = "polito";
    noise_cells(0.0);
    for (const double accuracy : config_.accuracies_m) noise_cells(accuracy);
    for (const double cycle : config_.cycles_s) {
      RoverDrive drive = drive_of(0.0, 0);
      drive.cycle_s = cycle;
      result_.cells.push_back(cell_of("cycle/" + cell_key("t", cycle), {seed_run(drive, 0.0)}));
    }
    grid_cells();
    add_baseline_table(result_);
    add_accuracy_table(config_, result_);
    add_grid_plots(config_, result_);
    add_hairpin_plots();
    return std::move(result_);
  }

 private:
  RoverDrive drive_of(double accuracy, int run) const {
    RoverDrive drive;
    drive.cycle_s = config_.cycle_s;
    drive.fix_accuracy_m = accuracy;
    drive.seed = static_cast<std::uint64_t>(config_.seed) + static_cast<std::uint64_t>(run);
    return drive;
  }

  SeedLookaheadConfig follower(double threshold_deg, double lookahead) const {
    SeedLookaheadConfig follower;
    follower.lookahead_m = lookahead;
    follower.crossed_within_m = lookahead;
    follower.speed_mps = config_.speed_kmh / 3.6;
    follower.steering_threshold_deg = threshold_deg;
    return follower;
  }

  DrivenTrack seed_track(const RoverDrive& drive, double threshold_deg) const {
    return drive_seed(drive, follower(threshold_deg, config_.lookahead_m), waypoints_,
                      plan_.path.start_pose().yaw, vehicle_);
  }
  Measured seed_run(const RoverDrive& drive, double threshold_deg) const {
    return measure(seed_track(drive, threshold_deg), plan_.path, waypoints_);
  }

  DrivenTrack our_track(const RoverDrive& drive, bool filtered) const {
    RoverTrackerConfig tracker = config_.tracker;
    tracker.filter.fix_accuracy_m = filtered ? drive.fix_accuracy_m : 0.0;
    return drive_ours(drive, tracker, reference_, vehicle_);
  }
  Measured our_run(const RoverDrive& drive, bool filtered) const {
    return measure(our_track(drive, filtered), plan_.path, waypoints_);
  }

  // The same accuracy for both followers; run by run they draw the same position errors.
  void noise_cells(double accuracy) {
    const int runs = accuracy > 0.0 ? config_.runs_count : 1;
    const std::string noise = accuracy > 0.0 ? "/" + cell_key("noise", accuracy) : "";
    const auto add = [&](const std::string& name,
                         const std::function<Measured(const RoverDrive&)>& run) {
      std::vector<Measured> measured;
      for (int i = 0; i < runs; ++i) measured.push_back(run(drive_of(accuracy, i)));
      result_.cells.push_back(cell_of(name, measured));
    };
    const auto on_arcs = [](RoverDrive drive) {
      drive.plant = RoverPlant::kArc;
      return drive;
    };
    const double threshold = config_.steering_threshold_deg;
    const std::string seed = "track/seed" + noise;
    const std::string ours = "track/ours" + noise;
    add(seed, [&](const RoverDrive& d) { return seed_run(d, 0.0); });
    add(seed + "/threshold", [&](const RoverDrive& d) { return seed_run(d, threshold); });
    add(seed + "/arc_plant", [&](const RoverDrive& d) { return seed_run(on_arcs(d), 0.0); });
    add(ours, [&](const RoverDrive& d) { return our_run(d, true); });
    add(ours + "/arc_plant", [&](const RoverDrive& d) { return our_run(on_arcs(d), true); });
    if (accuracy == 0.0) return;
    add(ours + "/raw", [&](const RoverDrive& d) { return our_run(d, false); });
    add(ours + "/" + cell_key("odometry", config_.odometry_scale_ratio), [&](RoverDrive d) {
      d.odometry_scale_ratio = config_.odometry_scale_ratio;
      return our_run(d, true);
    });
    add(ours + "/" + cell_key("heading", config_.heading_error_deg), [&](RoverDrive d) {
      d.heading_error_rad = deg_to_rad(config_.heading_error_deg);
      return our_run(d, true);
    });
  }

  void grid_cells() {
    for (const double lookahead : config_.grid_lookahead_m) {
      for (const double pitch : config_.grid_waypoint_pitch_m) {
        const std::vector<Point2> points = waypoints(plan_.path, pitch);
        const DrivenTrack track = drive_seed(drive_of(0.0, 0), follower(0.0, lookahead), points,
                                             plan_.path.start_pose().yaw, vehicle_);
        result_.cells.push_back(
            cell_of("grid/" + cell_key("LD", lookahead) + "/" + cell_key("WPP", pitch),
                    {measure(track, plan_.path, points)}));
      }
    }
  }

  void add_hairpin_plots() {
    const auto series = [&](const std::string& name, const std::vector<Point2>& positions) {
      return hairpin_series(name, config_.orchard, positions);
    };
    const PlotSeries planned = series("planned", waypoints(plan_.path, 0.1));
    Plot lookaheads{"First hairpin by lookahead ((004) Fig. 17, 19)", "x [m]", "y [m]", {planned}};
    for (const double lookahead : config_.grid_lookahead_m) {
      const DrivenTrack track = drive_seed(drive_of(0.0, 0), follower(0.0, lookahead), waypoints_,
                                           plan_.path.start_pose().yaw, vehicle_);
      lookaheads.series.push_back(series("seed, " + cell_key("LD", lookahead), track.positions));
    }
    lookaheads.series.push_back(series("ours", our_track(drive_of(0.0, 0), true).positions));
    result_.plots.push_back(std::move(lookaheads));
    for (const double accuracy : config_.accuracies_m) {
      const RoverDrive drive = drive_of(accuracy, 0);
      result_.plots.push_back({"First hairpin, " + cell_key("noise", accuracy) + " ((004) Fig. 22)",
                               "x [m]",
                               "y [m]",
                               {planned, series("seed", seed_track(drive, 0.0).positions),
                                series("ours", our_track(drive, true).positions)}});
    }
  }

  PolitoStudyConfig config_;
  OrchardPath plan_;
  Reference reference_;
  Vehicle vehicle_;
  std::vector<Point2> waypoints_;
  StudyResult result_;
};

}  // namespace

Result<StudyResult> run_polito_study(const PolitoStudyConfig& config) {
  auto plan = plan_orchard(config.orchard);
  if (!plan) return tl::unexpected<Error>(plan.error());
  return Study(config, std::move(*plan)).run();
}

}  // namespace headland
