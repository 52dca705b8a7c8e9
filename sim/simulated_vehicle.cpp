// SPDX-License-Identifier: Apache-2.0
#include "sim/simulated_vehicle.hpp"

#include <algorithm>
#include <cmath>

namespace headland {

SimulatedVehicle::SimulatedVehicle(const Vehicle& vehicle, const Pose2& start, double soc,
                                   const SensorConfig& sensors, std::uint64_t seed)
    : vehicle_(vehicle),
      sensors_(sensors),
      noise_(seed, "sim/sensors"),
      energy_j_(soc * vehicle.battery.capacity_j()) {
  state_.pose = start;
}

void SimulatedVehicle::step(const Command& command, LegKind kind, double dt) {
  const VehicleState before = state_;
  state_ = step_vehicle(vehicle_, state_, command, dt);
  DriveStep driven;
  driven.distance_m = 0.5 * std::abs(before.speed + state_.speed) * dt;
  driven.duration_s = dt;
  driven.speed_mps = std::abs(state_.speed);
  driven.speed_before_mps = driven.speed_mps;
  driven.working = kind == LegKind::kRow;
  const double drawn = step_energy(vehicle_.energy, driven);
  drawn_j_ += drawn;
  energy_j_ = std::max(0.0, energy_j_ - drawn);
}

double SimulatedVehicle::charge_full(double power) {
  const double missing = vehicle_.battery.capacity_j() - energy_j_;
  energy_j_ = vehicle_.battery.capacity_j();
  return missing / power;
}

VehicleState SimulatedVehicle::measure() {
  VehicleState measured = state_;
  const double accuracy = sensors_.position_accuracy_m;
  if (accuracy > 0.0) {
    measured.pose.x += noise_.uniform(-accuracy, accuracy);
    measured.pose.y += noise_.uniform(-accuracy, accuracy);
  }
  if (sensors_.heading_noise_deg > 0.0) {
    measured.pose.yaw =
        wrap_angle(measured.pose.yaw + deg_to_rad(sensors_.heading_noise_deg) * noise_.normal());
  }
  return measured;
}

}  // namespace headland
