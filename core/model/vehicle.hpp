// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"

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

/// Energy store and what driving costs on flat ground.
struct Battery {
  double capacity_wh = 10000.0;
  double reserve_soc = 0.15;
  double base_power_w = 300.0;
  double work_j_per_m = 500.0;
  double transit_j_per_m = 350.0;

  double capacity_j() const { return capacity_wh * 3600.0; }

  template <class V>
  void visit(V& v) {
    v("capacity_wh", capacity_wh, config::Range{1.0, 1e7},
      "Usable energy of the full battery [Wh]");
    v("reserve_soc", reserve_soc, config::Range{0.0, 0.9},
      "The plan never goes below this state of charge");
    v("base_power_w", base_power_w, config::Range{0.0, 1e6},
      "Drawn whenever the vehicle is on: computers, pumps, fans [W]");
    v("work_j_per_m", work_j_per_m, config::Range{0.0, 1e6},
      "Energy per metre with the implement at work in a row [J/m]");
    v("transit_j_per_m", transit_j_per_m, config::Range{0.0, 1e6},
      "Energy per metre outside rows, implement up [J/m]");
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
  double min_turning_radius_m = 0.0;
  double work_speed_mps = 1.5;
  double transit_speed_mps = 2.0;
  double turn_speed_mps = 1.0;
  double acceleration_mps2 = 1.0;
  bool can_reverse = true;
  double gear_change_s = 2.0;
  Footprint footprint;
  Battery battery;

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
      "Time constant of the steering actuator [s]");
    v("min_turning_radius_m", min_turning_radius_m, config::Range{0.0, 100.0},
      "Tightest planned turn [m]; 0: what the steering allows");
    v("work_speed_mps", work_speed_mps, config::Range{0.05, 20.0}, "In rows [m/s]");
    v("transit_speed_mps", transit_speed_mps, config::Range{0.05, 20.0},
      "On roads and headlands [m/s]");
    v("turn_speed_mps", turn_speed_mps, config::Range{0.05, 20.0}, "In headland turns [m/s]");
    v("acceleration_mps2", acceleration_mps2, config::Range{0.01, 100.0},
      "Speeding up and braking [m/s2]");
    v("can_reverse", can_reverse, "May plans use the reverse gear");
    v("gear_change_s", gear_change_s, config::Range{0.0, 600.0},
      "Standing time of a gear change [s]");
    v("footprint", footprint, "Outline");
    v("battery", battery, "Energy store and consumption");
  }
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::Steering> {
  static constexpr std::pair<headland::Steering, std::string_view> values[] = {
      {headland::Steering::kAckermann, "ackermann"},
      {headland::Steering::kDifferential, "differential"}};
};
