// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/model/command_delay.hpp"
#include "core/model/drive_cost.hpp"
#include "core/model/kinematics.hpp"
#include "core/model/measurement.hpp"
#include "core/world/ground.hpp"
#include "sim/ground_slip.hpp"
#include "sim/sensors.hpp"

namespace headland {

/// What a simulated vehicle meets, and what its sensors make of it.
struct SimulatedVehicleConfig {
  SensorConfig sensors;
  SlipConfig slip;
};

/// A vehicle and its battery in lock-step simulation: dead times, lags and limits of the actuators,
/// then the wheels, of which the ground lets through a part. It draws by the same model as plans
/// do, but over ground, at its true speed, acceleration, curvature, slope and slip. Deterministic
/// for a seed.
class SimulatedVehicle {
 public:
  /// `cycle` [s] > 0 is the duration of all its steps.
  SimulatedVehicle(const Vehicle& vehicle, const Pose2& start, double soc,
                   const SimulatedVehicleConfig& config, std::uint64_t seed, double cycle,
                   const Ground& ground = Ground());

  /// Drives a cycle under a held command, which acts after the dead times; `kind` says whether the
  /// implement is at work. Beyond the terrain it goes on at the last height. What a full battery
  /// cannot take is lost.
  void step(const Command& command, LegKind kind);
  /// Draws energy [J] for anything but driving.
  void draw(double energy);
  /// Stands at a charger up to `to_soc`; returns the time it takes [s]. Nothing where it has that
  /// charge already.
  double charge(const ChargeCurve& curve, double to_soc);

  const VehicleState& truth() const { return state_; }
  const Slip& slip() const { return slip_; }     ///< of the last step
  double yaw_rate() const { return yaw_rate_; }  ///< over ground, mean of the last step [rad/s]
  double distance() const { return ground_slip_.distance(); }  ///< driven over ground [m]
  /// What the sensors tell by `now` [s], which never decreases: once a tick. As Sensors::sense.
  std::span<const Measurement> sense(double now) { return sensors_.sense(state_, yaw_rate_, now); }
  /// The whole state with the errors of the fix alone: a new fix at every call.
  VehicleState measure() { return sensors_.fix(state_); }
  double soc() const { return energy_j_ / vehicle_.battery.capacity_j(); }
  double drawn_j() const { return drawn_j_; }  ///< net of what was recuperated
  double height() const { return height_; }    ///< of the ground under it [m]

 private:
  void draw_for(const VehicleState& before, bool working);

  Vehicle vehicle_;
  double cycle_s_;
  Ground ground_;
  CommandDelay delay_;
  GroundSlip ground_slip_;
  Sensors sensors_;
  VehicleState state_;
  Slip slip_;
  double yaw_rate_ = 0.0;
  double height_;
  double energy_j_;
  double drawn_j_ = 0.0;
};

}  // namespace headland
