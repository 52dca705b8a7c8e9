// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/geometry/path.hpp"
#include "core/model/drive_cost.hpp"

namespace headland {

/// A place that a tour leaves and enters: a row's end (left outwards, entered inwards), a charger
/// or a POI (driven into and out of in the same heading).
struct Site {
  Pose2 depart;
  Pose2 arrive;
  std::string name;  ///< for messages: "row ba20, north end"
};

/// Cheapest ways between all pairs of sites (the goals of 003, III-A).
class GoalGraph {
 public:
  struct Edge {
    DriveCost cost;  ///< infinite where there is no way
    Path path;       ///< leg numbers 0; empty where there is none
  };
  GoalGraph() = default;
  GoalGraph(int goals, std::vector<Edge> edges) : goals_(goals), edges_(std::move(edges)) {}

  int goals() const { return goals_; }
  const Edge& edge(int from, int to) const {
    return edges_[static_cast<std::size_t>(from) * static_cast<std::size_t>(goals_) +
                  static_cast<std::size_t>(to)];
  }

 private:
  int goals_ = 0;
  std::vector<Edge> edges_;
};

}  // namespace headland
