// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model/vehicle.hpp"

namespace headland::test {

/// Like seed 003's robot in its Ackermann configuration: 40 degrees of steering, held by a disc of
/// 1.5 m; with lags and dead times.
inline Vehicle field_robot() {
  Vehicle vehicle;
  vehicle.name = "field robot";
  vehicle.wheelbase_m = 1.5;
  vehicle.track_width_m = 1.2;
  vehicle.max_steering_deg = 40.0;
  vehicle.steering_rate_radps = 0.8;
  vehicle.steering_lag_s = 0.1;
  vehicle.min_turning_radius_m = 2.0;
  vehicle.transit_speed_mps = 1.5;
  vehicle.work_speed_mps = 1.5;
  vehicle.acceleration_mps2 = 1.0;
  vehicle.speed_lag_s = 0.1;
  vehicle.footprint = {1.9, 0.5, 1.5};
  return vehicle;
}

/// Long, slow to steer and to brake.
inline Vehicle tractor() {
  Vehicle vehicle;
  vehicle.name = "tractor";
  vehicle.wheelbase_m = 2.2;
  vehicle.max_steering_deg = 38.0;
  vehicle.steering_rate_radps = 0.5;
  vehicle.steering_lag_s = 0.2;
  vehicle.min_turning_radius_m = 3.2;
  vehicle.transit_speed_mps = 2.0;
  vehicle.work_speed_mps = 1.6;
  vehicle.acceleration_mps2 = 0.8;
  vehicle.speed_lag_s = 0.25;
  vehicle.speed_dead_time_s = 0.1;
  vehicle.steering_dead_time_s = 0.1;
  vehicle.footprint = {2.9, 0.9, 1.4};
  return vehicle;
}

/// Turns on the spot.
inline Vehicle rover() {
  Vehicle vehicle;
  vehicle.name = "rover";
  vehicle.steering = Steering::kDifferential;
  vehicle.wheelbase_m = 1.2;
  vehicle.track_width_m = 1.0;
  vehicle.steering_lag_s = 0.1;
  vehicle.min_turning_radius_m = 0.8;
  vehicle.transit_speed_mps = 1.5;
  vehicle.work_speed_mps = 1.2;
  vehicle.acceleration_mps2 = 1.0;
  vehicle.yaw_acceleration_radps2 = 2.0;
  vehicle.footprint = {0.9, 0.9, 1.1};
  return vehicle;
}

}  // namespace headland::test
