// SPDX-License-Identifier: Apache-2.0
#include "sim/simulated_vehicle.hpp"

#include <algorithm>
#include <cmath>

namespace headland {

SimulatedVehicle::SimulatedVehicle(const Vehicle& vehicle, const Pose2& start, double soc,
                                   const SensorConfig& sensors, std::uint64_t seed,
                                   const Ground& ground)
    : vehicle_(vehicle),
      sensors_(sensors),
      ground_(ground),
      noise_(seed, "sim/sensors"),
      height_(ground.height(start.position()).value_or(0.0)),
      energy_j_(soc * vehicle.battery.capacity_j()) {
  state_.pose = start;
}

void SimulatedVehicle::step(const Command& command, LegKind kind, double dt) {
  const VehicleState before = state_;
  state_ = step_vehicle(vehicle_, state_, command, dt);
  const Point2 place = state_.pose.position();
  const double height = ground_.height(place).value_or(height_);
  DriveStep driven;
  driven.distance_m = 0.5 * std::abs(before.speed + state_.speed) * dt;
  driven.rise_m = height - height_;
  driven.duration_s = dt;
  if (driven.distance_m > 0.0) {
    driven.curvature_1pm = wrap_angle(state_.pose.yaw - before.pose.yaw) / driven.distance_m;
  }
  driven.speed_mps = std::abs(state_.speed);
  driven.speed_before_mps = std::abs(before.speed);
  driven.soil = soil_resistance(ground_.soil(place));
  driven.working = kind == LegKind::kRow;
  height_ = height;
  draw(step_energy(vehicle_.energy, driven));
}

void SimulatedVehicle::draw(double energy) {
  const double before = energy_j_;
  energy_j_ = std::clamp(before - energy, 0.0, vehicle_.battery.capacity_j());
  drawn_j_ += before - energy_j_;
}

double SimulatedVehicle::charge(const ChargeCurve& curve, double to_soc) {
  const double from_soc = soc();
  if (to_soc <= from_soc) return 0.0;
  energy_j_ = to_soc * vehicle_.battery.capacity_j();
  return curve.time(from_soc, to_soc, vehicle_.battery.capacity_j());
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
