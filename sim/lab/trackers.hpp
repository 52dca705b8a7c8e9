// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <utility>

#include "control/estimation/estimation_config.hpp"
#include "control/estimation/estimator.hpp"
#include "control/lookahead_rover/rover_tracker.hpp"
#include "control/pure_pursuit/pure_pursuit.hpp"
#include "control/receding_horizon/horizon_estimator.hpp"
#include "control/receding_horizon/horizon_tracker.hpp"
#include "control/speed_limits.hpp"
#include "sim/simulated_vehicle.hpp"

namespace headland {

enum class TrackerKind {
  kAuto,         ///< pure pursuit for Ackermann, the rover's for differential vehicles
  kPurePursuit,  ///< ours
  kRover,        ///< ours
  kRhmc          ///< receding horizon
};

enum class EstimatorKind {
  kAuto,      ///< localizer where the vehicle perceives, else sensors
  kSensors,   ///< none: the sensors' last word, and no slip
  kEkf,       ///< with slip
  kRhe,       ///< with slip
  kLocalizer  ///< GNSS, wheels, gyroscope and lidar odometry; no slip
};

/// Who drives, on whose word, and their settings.
struct ControlConfig {
  TrackerKind tracker = TrackerKind::kAuto;
  EstimatorKind estimator = EstimatorKind::kAuto;
  PurePursuitConfig pure_pursuit;
  RoverTrackerConfig rover;
  HorizonConfig rhmc;
  EstimationConfig estimation;
  HorizonEstimatorConfig rhe;
  SpeedLimitConfig limits;

  template <class V>
  void visit(V& v) {
    v("tracker", tracker, "Who drives, on any vehicle");
    v("estimator", estimator, "Who tells the state, and what slip is known");
    v("pure_pursuit", pure_pursuit, "Of pure pursuit");
    v("rover", rover, "Of the rover's follower");
    v("rhmc", rhmc, "Of the receding-horizon controller");
    v("estimation", estimation, "The noise that estimators expect");
    v("rhe", rhe, "Of the receding-horizon estimator");
    v("limits", limits, "What slows the vehicle down below its legs' speeds");
  }
};

/// The tracker for a vehicle, at steps of `cycle` [s]: slip-aware where an estimator tells the
/// slip, with an adapter where it is made for the other kinematics. A position filter that is told
/// no accuracy takes that of the simulated fixes, unless an estimator filters already.
std::unique_ptr<Tracker> make_tracker(const Vehicle& vehicle, ControlConfig control,
                                      const SensorConfig& sensors, double cycle,
                                      const Clock* clock = nullptr);

/// Of those that need no lidar; null for kSensors, and for kAuto and kLocalizer (see Senses).
std::unique_ptr<Estimator> make_estimator(const Vehicle& vehicle, const ControlConfig& control,
                                          double cycle);

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::TrackerKind> {
  static constexpr std::pair<headland::TrackerKind, std::string_view> values[] = {
      {headland::TrackerKind::kAuto, "auto"},
      {headland::TrackerKind::kPurePursuit, "pure_pursuit"},
      {headland::TrackerKind::kRover, "rover"},
      {headland::TrackerKind::kRhmc, "rhmc"}};
};

template <>
struct headland::config::EnumNames<headland::EstimatorKind> {
  static constexpr std::pair<headland::EstimatorKind, std::string_view> values[] = {
      {headland::EstimatorKind::kAuto, "auto"},
      {headland::EstimatorKind::kSensors, "sensors"},
      {headland::EstimatorKind::kEkf, "ekf"},
      {headland::EstimatorKind::kRhe, "rhe"},
      {headland::EstimatorKind::kLocalizer, "localizer"}};
};
