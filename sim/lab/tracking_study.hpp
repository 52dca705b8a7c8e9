// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/model/vehicle.hpp"
#include "sim/lab/study_result.hpp"
#include "sim/lab/trackers.hpp"
#include "sim/lab/tracking/course.hpp"

namespace headland {

enum class StudyTracker { kSeedPurePursuit, kPurePursuit, kRover, kRhmcIpopt, kRhmcRti };
/// kNone: the trackers are told the true state, and no slip.
enum class StudyEstimator { kNone, kEkf, kRheNone, kRheUniform, kRheStructured };
enum class StudySlip { kNone, kConstant, kStepped, kCrossSlope };

/// Seed 003, III-D: who follows a path best when the wheels slip, on whose word. Every combination
/// of tracker, estimator, slip and speed drives the same course with the same sensor noise.
struct TrackingStudyConfig {
  std::string study = "tracking";
  int seed = 1;
  int runs_count = 5;        ///< of a cell, with other noise each
  int ipopt_runs_count = 2;  ///< of a cell with Ipopt, which is slow
  double cycle_s = 0.05;     ///< of sensors, estimators and trackers
  double settle_m = 5.0;     ///< figures begin there: the slip is unknown at the start
  std::vector<StudyTracker> trackers;
  std::vector<StudyEstimator> estimators;
  std::vector<StudySlip> slips;
  std::vector<double> speeds_mps;
  double loss_ratio = 0.1;  ///< of the constant and the stepped slip
  double side_deg = 3.0;
  double steering_offset_deg = 2.0;
  double cross_slope_ratio = 0.2;  ///< rise over run across the rows
  TrackingCourseConfig course;
  Vehicle vehicle;
  SensorConfig sensors;
  ControlConfig control;

  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("study", study, "Which study this file is for");
    v("seed", seed, config::Range{0, 1000000000}, "Of the sensors' noise");
    v("runs_count", runs_count, config::Range{1, 10000}, "Drives a cell");
    v("ipopt_runs_count", ipopt_runs_count, config::Range{1, 10000},
      "Drives a cell with Ipopt, if fewer");
    v("cycle_s", cycle_s, config::Range{0.005, 0.2}, "Of sensors and control [s]");
    v("settle_m", settle_m, config::kNonNegative, "Figures begin this far behind the start [m]");
    v("trackers", trackers, "Who drives");
    v("estimators", estimators, "On whose word");
    v("slips", slips, "On what ground");
    v("speeds_mps", speeds_mps, config::Range{0.05, 10.0}, "How fast [m/s]");
    v("loss_ratio", loss_ratio, config::Range{-0.3, 0.6}, "Longitudinal slip");
    v("side_deg", side_deg, config::Range{-20.0, 20.0}, "Side slip [deg]");
    v("steering_offset_deg", steering_offset_deg, config::Range{-20.0, 20.0},
      "Steering offset [deg]");
    v("cross_slope_ratio", cross_slope_ratio, config::Range{-0.5, 0.5},
      "Slope across the rows, rise over run, on which gravity makes the slip");
    v("course", course, "The way driven");
    v("vehicle", vehicle, "Who is driven");
    v("sensors", sensors, "What is measured");
    v("control", control, "Settings of trackers and estimators");
  }
};

/// A cell `<tracker>/<estimator>/<slip>/<speed>` each: overall_rms_m, row_rms_m, turn_rms_m, max_m,
/// fishtail_rms_m, cusp_max_m, recovery_s, loss_rmse_ratio, side_rmse_deg, offset_rmse_deg,
/// position_rmse_m, speed_rmse_mps, solve_ms and estimate_ms (of all ticks, with p99), solve_p99_ms
/// and estimate_p99_ms (mean of the runs' p99), duration_s, completed_ratio, wrong_gear_count.
/// Times are processor times, all else is deterministic, whatever `jobs` is, the number of drives
/// at once.
Result<StudyResult> run_tracking_study(const TrackingStudyConfig& config, int jobs = 1);

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::StudyTracker> {
  static constexpr std::pair<headland::StudyTracker, std::string_view> values[] = {
      {headland::StudyTracker::kSeedPurePursuit, "pp_seed"},
      {headland::StudyTracker::kPurePursuit, "pp"},
      {headland::StudyTracker::kRover, "rover"},
      {headland::StudyTracker::kRhmcIpopt, "rhmc_ipopt"},
      {headland::StudyTracker::kRhmcRti, "rhmc_rti"}};
};

template <>
struct headland::config::EnumNames<headland::StudyEstimator> {
  static constexpr std::pair<headland::StudyEstimator, std::string_view> values[] = {
      {headland::StudyEstimator::kNone, "none"},
      {headland::StudyEstimator::kEkf, "ekf"},
      {headland::StudyEstimator::kRheNone, "rhe_none"},
      {headland::StudyEstimator::kRheUniform, "rhe_uniform"},
      {headland::StudyEstimator::kRheStructured, "rhe_structured"}};
};

template <>
struct headland::config::EnumNames<headland::StudySlip> {
  static constexpr std::pair<headland::StudySlip, std::string_view> values[] = {
      {headland::StudySlip::kNone, "none"},
      {headland::StudySlip::kConstant, "constant"},
      {headland::StudySlip::kStepped, "stepped"},
      {headland::StudySlip::kCrossSlope, "cross_slope"}};
};
