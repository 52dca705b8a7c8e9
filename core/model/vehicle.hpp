// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"
#include "core/model/charge_curve.hpp"
#include "core/model/energy.hpp"
#include "core/model/sensor_mount.hpp"

namespace headland {

enum class Steering { kAckermann, kDifferential };

/// Outline of the vehicle in `base`: a rectangle around the rear axle's centre (differential: the
/// centre between the wheels).
struct Footprint {
  double front_m = 2.5;  ///< from base to the foremost point [m]
  double rear_m = 0.5;   ///< from base to the rearmost point [m]
  double width_m = 1.5;

  template <class V>
  void visit(V& v) {
    v("front_m", front_m, config::Range{0.05, 30.0}, "From base to the foremost point [m]");
    v("rear_m", rear_m, config::Range{0.0, 30.0}, "From base to the rearmost point [m]");
    v("width_m", width_m, config::Range{0.1, 60.0}, "Overall width [m]");
  }
};

/// Energy store. Charging is constant current up to `cv_soc` and then constant voltage: the power
/// falls linearly in soc to `end_power_ratio` of it when full.
struct Battery {
  double capacity_wh = 10000.0;
  double reserve_soc = 0.15;
  double charge_power_w = 1e6;
  double cv_soc = 1.0;
  double end_power_ratio = 0.1;

  double capacity_j() const { return capacity_wh * 3600.0; }
  double reserve_j() const { return reserve_soc * capacity_j(); }
  /// What the battery takes, whatever the charger gives.
  ChargeCurve acceptance() const {
    return ChargeCurve::cc_cv(charge_power_w, cv_soc, end_power_ratio);
  }

  template <class V>
  void visit(V& v) {
    v("capacity_wh", capacity_wh, config::Range{1.0, 1e7},
      "Usable energy of the full battery [Wh]");
    v("reserve_soc", reserve_soc, config::Range{0.0, 0.9},
      "The plan never goes below this state of charge");
    v("charge_power_w", charge_power_w, config::Range{1.0, 1e7},
      "Most it takes when charged at constant current [W]");
    v("cv_soc", cv_soc, config::Range{0.05, 1.0},
      "State of charge from which it is charged at constant voltage; 1: never");
    v("end_power_ratio", end_power_ratio, config::Range{0.01, 1.0},
      "Power when full over charge_power_w, if cv_soc is below 1");
  }
};

/// A vehicle: kinematics, actuators, outline, energy. One YAML file in config/vehicles/ each.
struct Vehicle {
  std::string name;
  Steering steering = Steering::kAckermann;
  double wheelbase_m = 2.0;
  double track_width_m = 1.2;
  double max_steering_deg = 35.0;
  double steering_rate_radps = 0.6;
  double steering_lag_s = 0.0;
  double steering_dead_time_s = 0.0;
  double min_turning_radius_m = 0.0;
  double work_speed_mps = 1.5;
  double transit_speed_mps = 2.0;
  double turn_speed_mps = 1.0;
  double reverse_speed_mps = 0.0;
  double acceleration_mps2 = 1.0;
  double speed_lag_s = 0.0;
  double speed_dead_time_s = 0.0;
  double yaw_acceleration_radps2 = 1000.0;
  bool can_reverse = true;
  double gear_change_s = 2.0;
  double max_pitch_deg = 20.0;
  double max_roll_deg = 15.0;
  Footprint footprint;
  EnergyModel energy;
  Battery battery;
  std::optional<SensorMount> lidar;

  double max_steering_rad() const { return deg_to_rad(max_steering_deg); }
  /// Radius used for planning [m]: the larger of what the steering allows and min_turning_radius_m.
  double turning_radius() const {
    const double geometric =
        steering == Steering::kAckermann ? wheelbase_m / std::tan(max_steering_rad()) : 0.0;
    return std::max(geometric, min_turning_radius_m);
  }

  std::optional<Error> check() const {
    if (turning_radius() > 0.0) return std::nullopt;
    return Error{ErrorCode::kOutOfRange,
                 "the planning radius is zero",
                 "a differential vehicle needs min_turning_radius_m > 0",
                 {{}, 0, "min_turning_radius_m"}};
  }

  template <class V>
  void visit(V& v) {
    v.required("name", name, "Name of the vehicle");
    v("steering", steering, "ackermann or differential");
    v("wheelbase_m", wheelbase_m, config::Range{0.1, 20.0}, "Between the axles [m]");
    v("track_width_m", track_width_m, config::Range{0.1, 20.0},
      "Between left and right wheels [m]");
    v("max_steering_deg", max_steering_deg, config::Range{1.0, 80.0},
      "Largest steering angle of the bicycle model [deg]");
    v("steering_rate_radps", steering_rate_radps, config::Range{0.01, 100.0},
      "Fastest change of the steering angle [rad/s]");
    v("steering_lag_s", steering_lag_s, config::Range{0.0, 2.0},
      "Time constant of the steering actuator, or of a differential vehicle's yaw rate [s]");
    v("steering_dead_time_s", steering_dead_time_s, config::Range{0.0, 2.0},
      "From a steering or yaw rate command until the actuator begins to follow [s]");
    v("min_turning_radius_m", min_turning_radius_m, config::Range{0.0, 100.0},
      "Tightest planned turn [m]; 0: what the steering allows");
    v("work_speed_mps", work_speed_mps, config::Range{0.05, 20.0}, "In rows [m/s]");
    v("transit_speed_mps", transit_speed_mps, config::Range{0.05, 20.0},
      "On roads and headlands [m/s]");
    v("turn_speed_mps", turn_speed_mps, config::Range{0.05, 20.0}, "In headland turns [m/s]");
    v("reverse_speed_mps", reverse_speed_mps, config::Range{0.0, 20.0},
      "Most in reverse gear [m/s]; 0: as fast as forwards");
    v("acceleration_mps2", acceleration_mps2, config::Range{0.01, 100.0},
      "Speeding up and braking [m/s2]");
    v("speed_lag_s", speed_lag_s, config::Range{0.0, 5.0}, "Time constant of the drive [s]");
    v("speed_dead_time_s", speed_dead_time_s, config::Range{0.0, 2.0},
      "From a speed command until the drive begins to follow [s]");
    v("yaw_acceleration_radps2", yaw_acceleration_radps2, config::Range{0.01, 1000.0},
      "Fastest change of a differential vehicle's yaw rate [rad/s2]; 1000: immediate");
    v("can_reverse", can_reverse, "May plans use the reverse gear");
    v("gear_change_s", gear_change_s, config::Range{0.0, 600.0},
      "Standing time of a gear change [s]");
    v("max_pitch_deg", max_pitch_deg, config::Range{0.1, 60.0}, "Steepest climb or descent [deg]");
    v("max_roll_deg", max_roll_deg, config::Range{0.1, 60.0}, "Steepest cross-slope [deg]");
    v("footprint", footprint, "Outline");
    v("energy", energy, "What driving and working draws");
    v("battery", battery, "Energy store and charging");
    v("lidar", lidar, "Where its lidar sits; left out: it has none");
  }
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::Steering> {
  static constexpr std::pair<headland::Steering, std::string_view> values[] = {
      {headland::Steering::kAckermann, "ackermann"},
      {headland::Steering::kDifferential, "differential"}};
};
