// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.hpp"
#include "global_planner/coverage/internal/free_space.hpp"

namespace headland::coverage {

/// The rows of a farm as obstacles to turning vehicles.
struct RowBodies {
  std::vector<RowBody> bodies;            ///< first the given rows, then the farm's others
  std::vector<std::vector<int>> parcels;  ///< numbers of the given rows, by parcel of the farm
  double widest = 0.0;                    ///< largest row spacing [m]
  double margin = 0.0;                    ///< what can be kept to neighbouring rows [m]
};

/// Each row is as wide as its parcel's spacing, or as its nearest neighbour allows, less a slit so
/// that neighbours do not touch. Error kTurnDoesNotFit names the first row that is too narrow.
Result<RowBodies> row_bodies(const Farm& farm, const std::vector<RowRef>& rows,
                             const Footprint& outline, double margin);

}  // namespace headland::coverage
