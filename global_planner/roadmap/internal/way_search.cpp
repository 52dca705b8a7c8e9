// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/internal/way_search.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace headland::internal {
namespace {

constexpr double kGravity = 9.80665;  // [m/s2]
constexpr double kInfinity = std::numeric_limits<double>::infinity();

GoalGraph::Edge no_way() { return {{kInfinity, kInfinity, kInfinity, kInfinity}, {}}; }

}  // namespace

WaySearch::WaySearch(const RoadGraph& graph, const TrackMaker& tracks, const Vehicle& vehicle,
                     const CostWeights& objective)
    : graph_(graph), tracks_(tracks), objective_(objective) {
  potential_per_metre_ = objective.per_j * vehicle.energy.recuperation_efficiency_ratio *
                         vehicle.energy.total_mass() * kGravity;
  add_arcs();
}

double WaySearch::potential(const Point2& p_map) const {
  return potential_per_metre_ > 0.0 ? potential_per_metre_ * tracks_.height(p_map) : 0.0;
}

double WaySearch::reduced_cost(const DriveCost& cost, const Point2& from, const Point2& to) const {
  return cost.value(objective_) + potential(from) - potential(to);
}

void WaySearch::add_arcs() {
  std::vector<std::pair<Heading, Arc>> all;
  for (std::size_t i = 0; i < graph_.edges.size(); ++i) {
    const RoadEdge& edge = graph_.edges[i];
    const Point2 from = graph_.pose(edge.from).position();
    const Point2 to = graph_.pose(edge.to).position();
    const int number = static_cast<int>(i);
    // Rounding alone can make them negative.
    if (edge.open.forwards) {
      const double cost = std::max(0.0, reduced_cost(edge.forwards, from, to));
      all.push_back({edge.from, {edge.to, number, false, cost}});
    }
    if (edge.open.backwards) {
      const double cost = std::max(0.0, reduced_cost(edge.backwards, to, from));
      all.push_back({looking_back(edge.to), {looking_back(edge.from), number, true, cost}});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  first_arc_.assign(static_cast<std::size_t>(graph_.headings()) + 1, 0);
  for (const auto& [from, arc] : all) {
    ++first_arc_[static_cast<std::size_t>(from) + 1];
    arcs_.push_back(arc);
  }
  for (std::size_t h = 1; h < first_arc_.size(); ++h) first_arc_[h] += first_arc_[h - 1];
}

/// How a heading was reached, and from where; by a departure of the goal, if from none.
struct WaySearch::Reached {
  double cost = kInfinity;  // reduced
  Heading from = -1;
  Leg leg;
};

GoalGraph WaySearch::ways(const std::vector<Site>& sites, const GoalLinks& links) const {
  const int goals = static_cast<int>(sites.size());
  std::vector<std::vector<int>> arrivals_at(static_cast<std::size_t>(graph_.headings()));
  for (std::size_t i = 0; i < links.arrivals.size(); ++i) {
    arrivals_at[static_cast<std::size_t>(links.arrivals[i].heading)].push_back(static_cast<int>(i));
  }
  std::vector<GoalGraph::Edge> edges;
  edges.reserve(static_cast<std::size_t>(goals * goals));
  for (int goal = 0; goal < goals; ++goal) search(goal, sites, links, arrivals_at, edges);
  return {goals, std::move(edges)};
}

// Dijkstra from one goal's departures to all goals' arrivals.
void WaySearch::search(int goal, const std::vector<Site>& sites, const GoalLinks& links,
                       const std::vector<std::vector<int>>& arrivals_at,
                       std::vector<GoalGraph::Edge>& edges) const {
  const Point2 start = sites[static_cast<std::size_t>(goal)].depart.position();
  std::vector<Reached> reached(static_cast<std::size_t>(graph_.headings()));
  std::vector<Reached> arrived(sites.size());
  using Entry = std::pair<double, Heading>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto offer = [](Reached& place, const Reached& way) {
    if (way.cost < place.cost) place = way;
    return place.cost == way.cost;
  };
  for (const DirectLink& link : links.direct) {
    if (link.from != goal) continue;
    const auto to = static_cast<std::size_t>(link.to);
    const double cost = reduced_cost(link.cost, start, sites[to].arrive.position());
    offer(arrived[to], {std::max(0.0, cost), -1, {&link.track, false, link.cost}});
  }
  for (const GoalLink& link : links.departures) {
    if (link.goal != goal) continue;
    const double cost = reduced_cost(link.cost, start, graph_.pose(link.heading).position());
    const Reached way{std::max(0.0, cost), -1, {&link.track, false, link.cost}};
    if (offer(reached[static_cast<std::size_t>(link.heading)], way)) {
      queue.push({way.cost, link.heading});
    }
  }
  while (!queue.empty()) {
    const auto [cost, heading] = queue.top();
    queue.pop();
    const auto h = static_cast<std::size_t>(heading);
    if (cost > reached[h].cost) continue;
    for (const int i : arrivals_at[h]) {
      const GoalLink& link = links.arrivals[static_cast<std::size_t>(i)];
      const auto to = static_cast<std::size_t>(link.goal);
      const double more =
          reduced_cost(link.cost, graph_.pose(heading).position(), sites[to].arrive.position());
      offer(arrived[to], {cost + std::max(0.0, more), heading, {&link.track, false, link.cost}});
    }
    for (int a = first_arc_[h]; a < first_arc_[h + 1]; ++a) {
      const Arc& arc = arcs_[static_cast<std::size_t>(a)];
      const RoadEdge& edge = graph_.edges[static_cast<std::size_t>(arc.edge)];
      Reached& place = reached[static_cast<std::size_t>(arc.to)];
      if (!(cost + arc.cost < place.cost)) continue;
      place = {cost + arc.cost,
               heading,
               {&edge.track, arc.backwards, arc.backwards ? edge.backwards : edge.forwards}};
      queue.push({place.cost, arc.to});
    }
  }
  for (std::size_t to = 0; to < sites.size(); ++to) {
    if (static_cast<int>(to) == goal) {
      edges.emplace_back();
      continue;
    }
    if (arrived[to].cost == kInfinity) {
      edges.push_back(no_way());
      continue;
    }
    std::vector<const Leg*> legs{&arrived[to].leg};
    for (Heading h = arrived[to].from; h >= 0; h = reached[static_cast<std::size_t>(h)].from) {
      legs.push_back(&reached[static_cast<std::size_t>(h)].leg);
    }
    GoalGraph::Edge edge;
    for (auto leg = legs.rbegin(); leg != legs.rend(); ++leg) {
      edge.cost += (*leg)->cost;
      edge.path.append((*leg)->track->path((*leg)->backwards));
    }
    edges.push_back(std::move(edge));
  }
}

}  // namespace headland::internal
