// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/way_pricer.hpp"

#include <algorithm>

namespace headland::coverage {

std::optional<DriveCost> WayPricer::price(const Path& path, LegKind kind, int cusps,
                                          double lost_s) const {
  if (path.empty()) return DriveCost{};
  const DriveCost lost = standing_cost(vehicle_, lost_s);
  const int within = static_cast<int>(path.segments().size()) - 1;
  if (ground_.uniform()) {
    return drive_cost(vehicle_, kind, path.length(), std::max(within, cusps)) + lost;
  }
  if (!ground_.flat() && check_slopes(vehicle_, ground_, path)) return std::nullopt;
  const Result<DriveCost> cost = path_cost(vehicle_, ground_, path, kind);
  if (!cost) return std::nullopt;
  const double standing = std::max(0, cusps - within) * vehicle_.gear_change_s;
  return *cost + standing_cost(vehicle_, standing) + lost;
}

double WayPricer::potential(const Point2& at) const {
  if (objective_.per_j == 0.0 || ground_.flat()) return 0.0;
  const auto sample = ground_.sample(at);
  if (!sample) return 0.0;
  return objective_.per_j * vehicle_.energy.recuperable_j_per_m() * sample->height;
}

}  // namespace headland::coverage
