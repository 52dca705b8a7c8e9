// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/config/visit.hpp"
#include "core/geometry/curve.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

enum class LegKind { kRow, kTurn, kTransit, kTask, kCharge };
enum class Objective { kEnergy, kTime, kLength, kWeighted };

/// What is minimised, as a weighted sum.
struct CostWeights {
  double per_j = 1.0;  ///< of energy [1/J]
  double per_s = 0.0;  ///< of time [1/s]
  double per_m = 0.0;  ///< of length [1/m]

  CostWeights() = default;
  CostWeights(double j, double s, double m) : per_j(j), per_s(s), per_m(m) {}
  /// Energy, time or length alone. Converts on purpose.
  CostWeights(Objective objective)
      : per_j(objective == Objective::kEnergy ? 1.0 : 0.0),
        per_s(objective == Objective::kTime ? 1.0 : 0.0),
        per_m(objective == Objective::kLength ? 1.0 : 0.0) {}
};

/// What driving something costs.
struct DriveCost {
  double length_m = 0.0;
  double duration_s = 0.0;
  double energy_j = 0.0;  ///< net; negative where more is recuperated than drawn
  double peak_j = 0.0;    ///< most that was drawn at any point since the beginning, >= energy_j, 0

  /// This and then `other`.
  DriveCost& operator+=(const DriveCost& other) {
    peak_j = std::max(peak_j, energy_j + other.peak_j);
    length_m += other.length_m;
    duration_s += other.duration_s;
    energy_j += other.energy_j;
    return *this;
  }
  friend DriveCost operator+(DriveCost a, const DriveCost& b) { return a += b; }
  /// The one number that is minimised; infinite where there is no way.
  double value(const CostWeights& weights) const {
    if (std::isinf(length_m)) return length_m;
    return weights.per_j * energy_j + weights.per_s * duration_s + weights.per_m * length_m;
  }
};

/// Speed of a kind of leg [m/s].
double leg_speed(const Vehicle& vehicle, LegKind kind);

/// Cost of `length` [m] driven as `kind` with `cusps` changes of gear, straight on flat ground.
DriveCost drive_cost(const Vehicle& vehicle, LegKind kind, double length, int cusps = 0,
                     SoilClass soil = SoilClass::kFirm);

/// Cost of `seconds` more on the way, as of standing: the base load goes on.
DriveCost standing_cost(const Vehicle& vehicle, double seconds);

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::LegKind> {
  static constexpr std::pair<headland::LegKind, std::string_view> values[] = {
      {headland::LegKind::kRow, "row"},
      {headland::LegKind::kTurn, "turn"},
      {headland::LegKind::kTransit, "transit"},
      {headland::LegKind::kTask, "task"},
      {headland::LegKind::kCharge, "charge"}};
};

template <>
struct headland::config::EnumNames<headland::Objective> {
  static constexpr std::pair<headland::Objective, std::string_view> values[] = {
      {headland::Objective::kEnergy, "energy"},
      {headland::Objective::kTime, "time"},
      {headland::Objective::kLength, "length"},
      {headland::Objective::kWeighted, "weighted"}};
};
