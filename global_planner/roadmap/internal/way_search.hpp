// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "global_planner/roadmap/goal_graph.hpp"
#include "global_planner/roadmap/internal/prm.hpp"

namespace headland::internal {

/// A track driven one way.
struct Leg {
  const Track* track = nullptr;
  bool backwards = false;
  DriveCost cost;
};

/// A goal's track to or from a heading of a node.
struct GoalLink {
  int goal = 0;
  Heading heading = 0;
  Track track;
  DriveCost cost;
};

/// A track from goal to goal.
struct DirectLink {
  int from = 0;
  int to = 0;
  Track track;
  DriveCost cost;
};

struct GoalLinks {
  std::vector<GoalLink> departures;
  std::vector<GoalLink> arrivals;
  std::vector<DirectLink> direct;
};

/// Searches cheapest ways over a roadmap. Energies may be negative; with the potential p of a
/// place, the least energy that rolling down from it can draw less, the reduced cost c + p(from) -
/// p(to) of any track is not: Johnson's potentials, for Dijkstra 1959.
class WaySearch {
 public:
  WaySearch(const RoadGraph& graph, const TrackMaker& tracks, const Vehicle& vehicle,
            const CostWeights& objective);

  /// The cheapest ways between all pairs of `sites`, joined by `links`.
  GoalGraph ways(const std::vector<Site>& sites, const GoalLinks& links) const;

  /// Of a track from place to place, by the objective.
  double reduced_cost(const DriveCost& cost, const Point2& from, const Point2& to) const;

 private:
  struct Arc {
    Heading to = 0;
    int edge = 0;
    bool backwards = false;
    double cost = 0.0;  // reduced
  };
  struct Reached;
  struct Spread;
  using ArrivalsAt = std::vector<std::vector<const GoalLink*>>;  // by heading
  double potential(const Point2& p_map) const;
  void add_arcs();
  Spread search(int goal, const std::vector<Site>& sites, const GoalLinks& links,
                const ArrivalsAt& arrivals_at) const;
  void start(int goal, const std::vector<Site>& sites, const GoalLinks& links,
             Spread& spread) const;
  GoalGraph::Edge way(const Spread& spread, int to) const;

  const RoadGraph& graph_;
  const TrackMaker& tracks_;
  CostWeights objective_;
  double potential_per_metre_ = 0.0;  // [J/m]
  std::vector<int> first_arc_;        // of heading h: arcs_[first_arc_[h] .. first_arc_[h + 1])
  std::vector<Arc> arcs_;
};

}  // namespace headland::internal
