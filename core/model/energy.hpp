// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/config/visit.hpp"
#include "core/model/soil.hpp"

namespace headland {

inline constexpr double kGravity = 9.80665;  ///< [m/s2]

/// What driving and working draws from the battery. Paths are plan views: lengths are horizontal,
/// and so rolling costs m g c per horizontal metre and climbing m g dz, whatever the slope.
struct EnergyModel {
  double mass_kg = 1000.0;
  double payload_kg = 0.0;
  double rotating_mass_kg = 0.0;
  double rolling_factor_ratio = 1.0;
  double drag_area_m2 = 0.0;
  double turn_loss_ratio = 0.0;
  double drive_efficiency_ratio = 0.8;
  double recuperation_efficiency_ratio = 0.0;
  double base_power_w = 300.0;
  double implement_power_w = 0.0;
  double implement_draft_n = 0.0;
  double drive_power_w = 0.0;

  double total_mass() const { return mass_kg + payload_kg; }  ///< [kg]
  /// What a metre of descent gives back at most [J/m]. Times the height it is a potential that
  /// makes the energies of ways non-negative: energy + potential(from) - potential(to) >= 0.
  double recuperable_j_per_m() const {
    return recuperation_efficiency_ratio * total_mass() * kGravity;
  }

  template <class V>
  void visit(V& v) {
    v("mass_kg", mass_kg, config::Range{1.0, 1e5}, "Empty vehicle with its implement [kg]");
    v("payload_kg", payload_kg, config::Range{0.0, 1e5}, "Carried: tank, crates [kg]");
    v("rotating_mass_kg", rotating_mass_kg, config::Range{0.0, 1e5},
      "Mass equivalent of wheels and motors when speeding up [kg]");
    v("rolling_factor_ratio", rolling_factor_ratio, config::Range{0.1, 10.0},
      "Rolling resistance of these wheels or tracks over the soil's table value");
    v("drag_area_m2", drag_area_m2, config::Range{0.0, 100.0},
      "Drag coefficient x frontal area [m2]");
    v("turn_loss_ratio", turn_loss_ratio, config::Range{0.0, 10.0},
      "Resistance in curves over the centripetal force");
    v("drive_efficiency_ratio", drive_efficiency_ratio, config::Range{0.05, 1.0},
      "Work at the wheels over energy from the battery");
    v("recuperation_efficiency_ratio", recuperation_efficiency_ratio, config::kFraction,
      "Energy into the battery over braking work at the wheels");
    v("base_power_w", base_power_w, config::Range{0.0, 1e6},
      "Drawn whenever the vehicle is on: computers, pumps, fans [W]");
    v("implement_power_w", implement_power_w, config::Range{0.0, 1e6},
      "Drawn by the implement at work: fans, pumps, mowers [W]");
    v("implement_draft_n", implement_draft_n, config::Range{0.0, 1e6},
      "Pull of the implement at work [N]");
    v("drive_power_w", drive_power_w, config::Range{0.0, 1e7},
      "Most power at the wheels while a speed is held [W]; 0: unlimited");
  }
};

/// A short stretch driven at about constant slope and curvature.
struct DriveStep {
  double distance_m = 0.0;  ///< horizontal, >= 0
  double rise_m = 0.0;      ///< height gained, negative downhill
  double duration_s = 0.0;
  double curvature_1pm = 0.0;
  double speed_mps = 0.0;         ///< at the end of the step
  double speed_before_mps = 0.0;  ///< at its beginning
  SoilResistance soil = soil_resistance(SoilClass::kFirm);
  bool working = false;  ///< implement down
};

/// Energy drawn from the battery [J] in a step; negative where more is recuperated than drawn:
///   work = m g rise + (m + m_rot) (v^2 - v_before^2) / 2 + c_roll m g ds + rho/2 c_w A v^2 ds
///        + c_turn m v^2 |kappa| ds + draft ds
///   drawn = work / ((1 - slip) eta_drive), or work eta_recuperation where work < 0; + loads dt
///   slip = slip_per_traction work / (m g ds), at most 0.5
/// Work is that of SUMO 1.15 (Kurczveil, Lopez, Schnieder 2014; tested side by side); slip,
/// implement and loads beside the drive are ours. At constant speed no step is cheaper than
/// eta_recuperation m g rise, so that drive energies plus that potential are never negative.
double step_energy(const EnergyModel& model, const DriveStep& step);

/// Power at the wheels [W] over a step of that model: work / (1 - slip) per time; zero where the
/// wheels brake.
double wheel_power(const EnergyModel& model, const DriveStep& step);

}  // namespace headland
