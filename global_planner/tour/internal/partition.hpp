// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "global_planner/tour/internal/model.hpp"

namespace headland::tour {

/// A way to do a set of tasks: by one route, or shared among several.
struct Share {
  double value = 0.0;   ///< cost without the span
  double time_s = 0.0;  ///< latest finish
  int route = -1;       ///< of a route: what its search calls it; of several: the last one's share
  unsigned part = 0;    ///< the last route's set
  int rest = 0;         ///< the share of all other routes, in the layer before
};

/// Shares of every set of tasks, none both dearer and later than another.
using RouteTable = std::vector<std::vector<Share>>;

/// Adds a share unless another is as good; where the span is worth nothing, only the cheapest. Says
/// whether it did.
bool add_share(std::vector<Share>& shares, const Share& share, bool span_counts);

struct Partition {
  double cost = kNever;                     ///< the whole objective
  std::vector<std::pair<int, int>> routes;  ///< kind, and what its search calls the route
};

/// The cheapest way to share the tasks among the vehicles, one table of routes per kind, with tasks
/// left out at the price of their reward. Nothing if there is none. O(vehicles 3^tasks).
std::optional<Partition> cheapest_partition(const Model& model,
                                            const std::vector<RouteTable>& tables);

}  // namespace headland::tour
