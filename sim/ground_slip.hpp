// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "core/config/visit.hpp"
#include "core/model/energy.hpp"
#include "core/model/slip.hpp"
#include "core/world/ground.hpp"

namespace headland {

inline constexpr config::Range kLossRange{-0.3, 0.6};         ///< of Slip::loss_ratio
inline constexpr config::Range kSlipAngleRange{-20.0, 20.0};  ///< of its angles [deg]

/// Offsets of the slip that hold from a driven distance on.
struct SlipChange {
  double at_m = 0.0;
  double loss_ratio = 0.0;
  double side_deg = 0.0;
  double steering_offset_deg = 0.0;

  template <class V>
  void visit(V& v) {
    v.required("at_m", at_m, config::kNonNegative,
               "Driven over ground since the start; acts in the first step that begins there [m]");
    v("loss_ratio", loss_ratio, kLossRange, "In place of the constant from there on");
    v("side_deg", side_deg, kSlipAngleRange, "In place of the constant from there on [deg]");
    v("steering_offset_deg", steering_offset_deg, kSlipAngleRange,
      "In place of the constant from there on [deg]");
  }
};

/// Slip that wanders: each component an Ornstein-Uhlenbeck process over the driven distance, which
/// starts anywhere in its long-run distribution.
struct SlipWalk {
  double loss_ratio = 0.0;
  double loss_memory_m = 20.0;
  double side_deg = 0.0;
  double side_memory_m = 20.0;
  double steering_offset_deg = 0.0;
  double steering_offset_memory_m = 50.0;

  template <class V>
  void visit(V& v) {
    v("loss_ratio", loss_ratio, config::Range{0.0, 0.3}, "Standard deviation of the loss");
    v("loss_memory_m", loss_memory_m, config::kPositive,
      "Way over which its correlation falls to 1/e [m]");
    v("side_deg", side_deg, config::Range{0.0, 10.0}, "Standard deviation of the side slip [deg]");
    v("side_memory_m", side_memory_m, config::kPositive,
      "Way over which its correlation falls to 1/e [m]");
    v("steering_offset_deg", steering_offset_deg, config::Range{0.0, 10.0},
      "Standard deviation of the steering offset [deg]");
    v("steering_offset_memory_m", steering_offset_memory_m, config::kPositive,
      "Way over which its correlation falls to 1/e [m]");
  }
};

/// How the ground lets a simulated vehicle down: the sum of constants (or the changes that have
/// replaced them), terrain and walk. All zero, as by default: it does not.
struct SlipConfig {
  double loss_ratio = 0.0;
  double side_deg = 0.0;
  double steering_offset_deg = 0.0;
  std::vector<SlipChange> changes;
  double terrain_factor_ratio = 0.0;
  SlipWalk walk;

  std::optional<Error> check() const;  ///< changes are in the order of their distance

  template <class V>
  void visit(V& v) {
    v("loss_ratio", loss_ratio, kLossRange,
      "The vehicle goes 1 - this times as far as its wheels roll");
    v("side_deg", side_deg, kSlipAngleRange,
      "Direction of travel against the heading, positive left [deg]");
    v("steering_offset_deg", steering_offset_deg, kSlipAngleRange,
      "Added to the steering angle, positive left [deg]");
    v("changes", changes, "Steps of the three above along the way");
    v("terrain_factor_ratio", terrain_factor_ratio, config::Range{0.0, 3.0},
      "Slip by soil, slope and manoeuvre over that of the soil's table; 0: none, 1: as the energy "
      "model has it");
    v("walk", walk, "Slip that wanders along the way");
  }
};

/// A step of the wheels, of which the ground lets through a part.
struct WheelStep {
  Pose2 pose;                 ///< at its beginning
  double speed_before = 0.0;  ///< of the wheels at its beginning [m/s], signed
  double speed = 0.0;         ///< at its end
  double yaw_rate = 0.0;      ///< of the vehicle over ground, most lately known [rad/s]
  double duration = 0.0;      ///< [s]
  bool working = false;       ///< implement down
};

/// The slip of a simulated vehicle, step by step. Terrain acts as on an isotropic tyre with small
/// slip: it slips by the soil's slip_per_traction times the force on it over the weight,
///   loss = factor c F_along / W           F_along: the traction of the energy model
///   side = -+ factor c F_left / W [rad]   F_left / W = slope across + v psi' / g
/// so that the vehicle drifts downhill and outwards in either gear (upper sign: forward; in reverse
/// the direction of travel is turned the other way for that). The sum is held to -0.3..0.6 and
/// +-20 degrees. Beyond the terrain the ground is level. Deterministic for a seed; a step does not
/// allocate.
class GroundSlip {
 public:
  GroundSlip(const SlipConfig& config, const EnergyModel& energy, const Ground& ground,
             std::uint64_t seed);

  /// Of the coming step; the distance moves on by it.
  Slip step(const WheelStep& wheels);
  double distance() const { return distance_m_; }  ///< driven over ground so far [m]
  /// What the wheels lost in the last step beyond what the energy model's slip explains: the loss
  /// less that by terrain, never below zero.
  double excess_loss() const { return excess_loss_; }

 private:
  // An Ornstein-Uhlenbeck process over distance.
  class Walk {
   public:
    Walk(double deviation, double memory, std::uint64_t seed, std::string_view name);
    double value() const { return value_; }
    void advance(double distance);

   private:
    double deviation_;
    double memory_m_;
    RandomStream random_;
    double value_;
  };

  struct Terrain {
    double loss_ratio = 0.0;
    double side_rad = 0.0;
  };
  Terrain by_terrain(const WheelStep& wheels) const;

  SlipConfig config_;
  EnergyModel energy_;
  Ground ground_;
  SlipChange offsets_;
  std::size_t next_change_ = 0;
  Walk loss_;
  Walk side_;
  Walk steering_offset_;
  double distance_m_ = 0.0;
  double loss_ratio_ = 0.0;  // of the last step
  double excess_loss_ = 0.0;
};

}  // namespace headland
