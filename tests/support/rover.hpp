// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model/vehicle.hpp"

namespace headland::test {

/// A differential robot that does everything at 1 m/s.
inline Vehicle rover() {
  Vehicle vehicle;
  vehicle.name = "rover";
  vehicle.steering = Steering::kDifferential;
  vehicle.min_turning_radius_m = 1.0;
  vehicle.work_speed_mps = 1.0;
  vehicle.transit_speed_mps = 1.0;
  vehicle.turn_speed_mps = 1.0;
  return vehicle;
}

}  // namespace headland::test
