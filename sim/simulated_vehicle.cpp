// SPDX-License-Identifier: Apache-2.0
#include "sim/simulated_vehicle.hpp"

#include <algorithm>
#include <cmath>

namespace headland {

SimulatedVehicle::SimulatedVehicle(const Vehicle& vehicle, const Pose2& start, double soc,
                                   const SimulatedVehicleConfig& config, std::uint64_t seed,
                                   double cycle, const Ground& ground)
    : vehicle_(vehicle),
      cycle_s_(cycle),
      ground_(ground),
      delay_(vehicle, cycle),
      ground_slip_(config.slip, vehicle.energy, ground, seed),
      sensors_(vehicle, config.sensors, seed),
      height_(ground.height(start.position()).value_or(0.0)),
      energy_j_(soc * vehicle.battery.capacity_j()) {
  state_.pose = start;
}

void SimulatedVehicle::step(const Command& command, LegKind kind) {
  const VehicleState before = state_;
  const bool working = kind == LegKind::kRow;
  const Command acting = delay_.push(command);
  const double speed = step_speed(vehicle_, before.speed, acting.speed, cycle_s_);
  slip_ = ground_slip_.step({before.pose, before.speed, speed, yaw_rate_, cycle_s_, working});
  state_ = step_vehicle(vehicle_, before, acting, cycle_s_, slip_);
  yaw_rate_ = wrap_angle(state_.pose.yaw - before.pose.yaw) / cycle_s_;
  draw_for(before, working);
}

void SimulatedVehicle::draw_for(const VehicleState& before, bool working) {
  const Point2 place = state_.pose.position();
  const double height = ground_.height(place).value_or(height_);
  const double keep = 1.0 - slip_.loss_ratio;
  DriveStep driven;
  driven.distance_m = 0.5 * std::abs(before.speed + state_.speed) * cycle_s_ * keep;
  driven.rise_m = height - height_;
  driven.duration_s = cycle_s_;
  if (driven.distance_m > 0.0) {
    driven.curvature_1pm = wrap_angle(state_.pose.yaw - before.pose.yaw) / driven.distance_m;
  }
  // Over ground, at the slip of this step throughout: a step of the slip itself does no work.
  driven.speed_mps = keep * std::abs(state_.speed);
  driven.speed_before_mps = keep * std::abs(before.speed);
  driven.soil = soil_resistance(ground_.soil(place));
  driven.working = working;
  driven.excess_slip_ratio = ground_slip_.excess_loss();
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

}  // namespace headland
