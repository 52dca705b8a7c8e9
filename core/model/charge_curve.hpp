// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/config/visit.hpp"

namespace headland {

/// A point of a charging curve: power by state of charge.
struct ChargePoint {
  double soc = 0.0;
  double power_w = 0.0;

  template <class V>
  void visit(V& v) {
    v.required("soc", soc, config::kFraction, "State of charge");
    v.required("power_w", power_w, config::Range{1.0, 1e7}, "Into the battery [W]");
  }
};

/// Power into a battery by its state of charge, linear between points and constant beyond them.
class ChargeCurve {
 public:
  /// Constant power [W].
  explicit ChargeCurve(double power_w = 1.0) : points_{{0.0, power_w}, {1.0, power_w}} {}
  /// Points by rising soc, their power above zero; at least one (checked).
  explicit ChargeCurve(std::vector<ChargePoint> points);
  /// Constant power up to `cv_soc`, then falling linearly in soc to `end_ratio` of it at full
  /// (constant current, constant voltage).
  static ChargeCurve cc_cv(double power_w, double cv_soc, double end_ratio);

  const std::vector<ChargePoint>& points() const { return points_; }
  double power(double soc) const;  ///< [W]
  double max_power() const;        ///< [W]
  /// Time [s] to charge a battery of `capacity` [J] from one soc to a higher one; exact.
  double time(double from_soc, double to_soc, double capacity) const;
  /// State of charge after `time` [s]; at most 1. Inverse of time().
  double soc_after(double from_soc, double time, double capacity) const;
  /// The lower of two curves, everywhere: what a charger gives and what a battery takes.
  friend ChargeCurve lower(const ChargeCurve& a, const ChargeCurve& b);
  bool concave_energy() const;  ///< power never rises with soc

 private:
  std::vector<ChargePoint> points_;
};

}  // namespace headland
