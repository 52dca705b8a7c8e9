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

DriveCost drive_cost(const Vehicle& vehicle, LegKind kind, double length, int cusps,
                     SoilClass soil) {
  const double speed = leg_speed(vehicle, kind);
  DriveStep step;
  step.distance_m = length;
  step.duration_s = length / speed;
  step.speed_mps = speed;
  step.speed_before_mps = speed;
  step.soil = soil_resistance(soil);
  step.working = kind == LegKind::kRow;
  const double standing = cusps * vehicle.gear_change_s;
  const double energy = step_energy(vehicle.energy, step) + vehicle.energy.base_power_w * standing;
  return {length, step.duration_s + standing, energy, energy};
}

DriveCost standing_cost(const Vehicle& vehicle, double seconds) {
  const double energy = seconds * vehicle.energy.base_power_w;
  return {0.0, seconds, energy, energy};
}

}  // namespace headland
