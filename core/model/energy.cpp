// SPDX-License-Identifier: Apache-2.0
#include "core/model/energy.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kAirDensity = 1.2041;  // at 20 degrees [kg/m3]
constexpr double kMostSlip = 0.5;       // beyond it the vehicle is stuck

}  // namespace

double step_energy(const EnergyModel& model, const DriveStep& step) {
  const double mass = model.total_mass();
  const double weight = mass * kGravity;
  const double v2 = step.speed_mps * step.speed_mps;
  const double kinetic =
      0.5 * (mass + model.rotating_mass_kg) * (v2 - step.speed_before_mps * step.speed_before_mps);
  const double rolling =
      model.rolling_factor_ratio * step.soil.rolling_ratio * weight * step.distance_m;
  const double air = 0.5 * kAirDensity * model.drag_area_m2 * v2 * step.distance_m;
  const double turning =
      model.turn_loss_ratio * mass * v2 * std::abs(step.curvature_1pm) * step.distance_m;
  const double draft = step.working ? model.implement_draft_n * step.distance_m : 0.0;
  const double work = weight * step.rise_m + kinetic + rolling + air + turning + draft;
  const double load =
      (model.base_power_w + (step.working ? model.implement_power_w : 0.0)) * step.duration_s;
  if (work <= 0.0) return work * model.recuperation_efficiency_ratio + load;
  const double traction = step.distance_m > 0.0 ? work / (weight * step.distance_m) : 0.0;
  const double slip = std::min(kMostSlip, step.soil.slip_per_traction * traction);
  return work / (1.0 - slip) / model.drive_efficiency_ratio + load;
}

double wheel_power(const EnergyModel& model, const DriveStep& step) {
  DriveStep drive = step;
  drive.duration_s = 0.0;  // no loads beside the drive
  const double drawn = step_energy(model, drive);
  return std::max(0.0, drawn) * model.drive_efficiency_ratio / step.duration_s;
}

}  // namespace headland
