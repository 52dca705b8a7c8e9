// SPDX-License-Identifier: Apache-2.0
#include "core/model/drive_cost.hpp"

namespace headland {

double leg_speed(const Vehicle& vehicle, LegKind kind) {
  switch (kind) {
    case LegKind::kRow:
    case LegKind::kTask:
      return vehicle.work_speed_mps;
    case LegKind::kTurn:
      return vehicle.turn_speed_mps;
    case LegKind::kTransit:
    case LegKind::kCharge:
      break;
  }
  return vehicle.transit_speed_mps;
}

DriveCost drive_cost(const Vehicle& vehicle, LegKind kind, double length, int cusps) {
  const double duration = length / leg_speed(vehicle, kind) + cusps * vehicle.gear_change_s;
  const double per_metre =
      kind == LegKind::kRow ? vehicle.battery.work_j_per_m : vehicle.battery.transit_j_per_m;
  return {length, duration, vehicle.battery.base_power_w * duration + per_metre * length};
}

}  // namespace headland
