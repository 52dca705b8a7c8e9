// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.hpp"
#include "core/geometry/path.hpp"
#include "core/geometry/region.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

struct HybridAstarOptions {
  double cell_m = 0.5;            ///< of the search grid
  int headings = 72;              ///< of the search grid
  double margin_m = 0.1;          ///< kept between the outline and the edge of the area
  double reverse_weight = 1.5;    ///< cost of a metre in reverse over one forward
  double cusp_cost_m = 3.0;       ///< of a change of gear, in metres
  double steering_weight = 0.05;  ///< of turning: cost per radian, in metres
  int max_expansions = 200000;
};

/// Free-space planning among obstacles: Hybrid A* (Dolgov, Thrun, Montemerlo, Diebel 2010) over
/// (x, y, heading) with the vehicle's outline, both gears, Reeds-Shepp analytic expansion, and the
/// larger of the obstacle-free Reeds-Shepp and the obstacle-aware grid distance as heuristic.
class HybridAstar {
 public:
  HybridAstar(const Region& area, const Vehicle& vehicle, const HybridAstarOptions& options = {});

  /// A path of exact arcs and straights from pose to pose; leg numbers 0. Deterministic. Errors:
  /// kNoPath says which pose does not fit, or that the search is exhausted or out of its budget.
  Result<Path> plan(const Pose2& from, const Pose2& to) const;

 private:
  const Region& area_;
  Vehicle vehicle_;
  HybridAstarOptions options_;
};

}  // namespace headland
