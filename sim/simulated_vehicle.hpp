// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/random.hpp"
#include "core/config/visit.hpp"
#include "core/model/drive_cost.hpp"
#include "core/model/kinematics.hpp"

namespace headland {

/// What a simulated vehicle's sensors get wrong.
struct SensorConfig {
  double position_accuracy_m = 0.0;
  double heading_noise_deg = 0.0;

  template <class V>
  void visit(V& v) {
    v("position_accuracy_m", position_accuracy_m, config::kNonNegative,
      "Fixes are off by a uniform error within +- this in x and in y (seed 004) [m]");
    v("heading_noise_deg", heading_noise_deg, config::kNonNegative,
      "Standard deviation of the heading's white noise [deg]");
  }
};

/// A vehicle and its battery in lock-step simulation on flat ground. Deterministic for a seed.
class SimulatedVehicle {
 public:
  SimulatedVehicle(const Vehicle& vehicle, const Pose2& start, double soc,
                   const SensorConfig& sensors, std::uint64_t seed);

  /// Drives `dt` [s] under a held command; `kind` says whether the implement is at work.
  void step(const Command& command, LegKind kind, double dt);
  /// Stands at a charger that gives `power` [W] until full; returns the time it took [s].
  double charge_full(double power);

  const VehicleState& truth() const { return state_; }
  /// The state as sensors give it: a new fix at every call.
  VehicleState measure();
  double soc() const { return energy_j_ / vehicle_.battery.capacity_j(); }
  double drawn_j() const { return drawn_j_; }

 private:
  Vehicle vehicle_;
  SensorConfig sensors_;
  RandomStream noise_;
  VehicleState state_;
  double energy_j_;
  double drawn_j_ = 0.0;
};

}  // namespace headland
