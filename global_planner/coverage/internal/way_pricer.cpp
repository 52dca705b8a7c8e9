// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/way_pricer.hpp"

namespace headland::coverage {

std::optional<DriveCost> WayPricer::price(const Path& path, LegKind kind) const {
  if (path.empty()) return DriveCost{};
  if (ground_.uniform()) {
    const int cusps = static_cast<int>(path.segments().size()) - 1;
    return drive_cost(vehicle_, kind, path.length(), cusps);
  }
  if (!ground_.flat() && check_slopes(vehicle_, ground_, path)) return std::nullopt;
  const Result<DriveCost> cost = path_cost(vehicle_, ground_, path, kind);
  return cost ? std::optional(*cost) : std::nullopt;
}

double WayPricer::potential(const Point2& at) const {
  if (objective_.per_j == 0.0 || ground_.flat()) return 0.0;
  const auto sample = ground_.sample(at);
  const EnergyModel& energy = vehicle_.energy;
  const double per_metre = energy.recuperation_efficiency_ratio * energy.total_mass() * kGravity;
  return sample ? per_metre * sample->height : 0.0;
}

}  // namespace headland::coverage
