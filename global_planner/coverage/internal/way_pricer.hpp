// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/world/ground.hpp"
#include "global_planner/coverage/internal/turn.hpp"

namespace headland::coverage {

/// Prices ways over the ground for one vehicle. Thread-safe.
class WayPricer {
 public:
  WayPricer(const Vehicle& vehicle, const Ground& ground, const CostWeights& objective)
      : vehicle_(vehicle), ground_(ground), objective_(objective) {}

  const CostWeights& objective() const { return objective_; }
  /// What the path costs when driven as `kind`; nothing where it leaves the terrain or is steeper
  /// than the vehicle may drive. `cusps`: its changes of gear where those at its ends count too;
  /// -1: only those within it. `lost_s`: time lost to slowing down [s].
  std::optional<DriveCost> price(const Path& path, LegKind kind, int cusps = -1,
                                 double lost_s = 0.0) const;
  /// What a way costs at least per metre on flat ground of the default soil.
  CostRate flat_rate(LegKind kind) const { return cost_rate(vehicle_, kind, objective_); }
  /// Added to the cost of every way, potential(from) - potential(to) makes it non-negative: what
  /// recuperation can return of the height (Johnson 1977's potentials). Zero where heights do not
  /// count or are not known.
  double potential(const Point2& at) const;

 private:
  Vehicle vehicle_;
  Ground ground_;
  CostWeights objective_;
};

}  // namespace headland::coverage
