// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/random.hpp"
#include "core/config/visit.hpp"
#include "core/model/drive_cost.hpp"
#include "core/model/kinematics.hpp"
#include "core/world/ground.hpp"

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

/// A vehicle and its battery in lock-step simulation. It draws by the same model as plans do, but
/// at its true speed, acceleration, curvature and slope. Deterministic for a seed.
class SimulatedVehicle {
 public:
  SimulatedVehicle(const Vehicle& vehicle, const Pose2& start, double soc,
                   const SensorConfig& sensors, std::uint64_t seed,
                   const Ground& ground = Ground());

  /// Drives `dt` [s] under a held command; `kind` says whether the implement is at work. Beyond the
  /// terrain it goes on at the last height. What a full battery cannot take is lost.
  void step(const Command& command, LegKind kind, double dt);
  /// Draws energy [J] for anything but driving.
  void draw(double energy);
  /// Stands at a charger up to `to_soc`; returns the time it takes [s]. Nothing where it has that
  /// charge already.
  double charge(const ChargeCurve& curve, double to_soc);

  const VehicleState& truth() const { return state_; }
  /// The state as sensors give it: a new fix at every call.
  VehicleState measure();
  double soc() const { return energy_j_ / vehicle_.battery.capacity_j(); }
  double drawn_j() const { return drawn_j_; }  ///< net of what was recuperated
  double height() const { return height_; }    ///< of the ground under it [m]

 private:
  Vehicle vehicle_;
  SensorConfig sensors_;
  Ground ground_;
  RandomStream noise_;
  VehicleState state_;
  double height_;
  double energy_j_;
  double drawn_j_ = 0.0;
};

}  // namespace headland
