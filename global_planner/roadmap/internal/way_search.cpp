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
  potential_per_metre_ = objective.per_j * vehicle.energy.recuperable_j_per_m();
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

/// How a place was reached: from which heading, if not by the goal's own link, and over what.
struct WaySearch::Reached {
  double cost = kInfinity;  // reduced
  Heading from = -1;
  Leg leg;
};

/// A search from one goal.
struct WaySearch::Spread {
  std::vector<Reached> headings;
  std::vector<Reached> goals;
  using Entry = std::pair<double, Heading>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;

  void reach_heading(Heading heading, const Reached& way) {
    Reached& place = headings[static_cast<std::size_t>(heading)];
    if (!(way.cost < place.cost)) return;
    place = way;
    queue.push({way.cost, heading});
  }
  void reach_goal(int goal, const Reached& way) {
    Reached& place = goals[static_cast<std::size_t>(goal)];
    if (way.cost < place.cost) place = way;
  }
};

GoalGraph WaySearch::ways(const std::vector<Site>& sites, const GoalLinks& links) const {
  const int goals = static_cast<int>(sites.size());
  ArrivalsAt arrivals_at(static_cast<std::size_t>(graph_.headings()));
  for (const GoalLink& link : links.arrivals) {
    arrivals_at[static_cast<std::size_t>(link.heading)].push_back(&link);
  }
  std::vector<GoalGraph::Edge> edges;
  edges.reserve(static_cast<std::size_t>(goals * goals));
  for (int from = 0; from < goals; ++from) {
    const Spread spread = search(from, sites, links, arrivals_at);
    for (int to = 0; to < goals; ++to) {
      edges.push_back(from == to ? GoalGraph::Edge{} : way(spread, to));
    }
  }
  return {goals, std::move(edges)};
}

// Dijkstra 1959, from one goal's departures to all goals' arrivals.
WaySearch::Spread WaySearch::search(int goal, const std::vector<Site>& sites,
                                    const GoalLinks& links, const ArrivalsAt& arrivals_at) const {
  Spread spread;
  spread.headings.resize(static_cast<std::size_t>(graph_.headings()));
  spread.goals.resize(sites.size());
  start(goal, sites, links, spread);
  while (!spread.queue.empty()) {
    const auto [cost, heading] = spread.queue.top();
    spread.queue.pop();
    const auto h = static_cast<std::size_t>(heading);
    if (cost > spread.headings[h].cost) continue;
    for (const GoalLink* link : arrivals_at[h]) {
      const Point2 end = sites[static_cast<std::size_t>(link->goal)].arrive.position();
      const double more = reduced_cost(link->cost, graph_.pose(heading).position(), end);
      spread.reach_goal(link->goal,
                        {cost + std::max(0.0, more), heading, {&link->track, false, link->cost}});
    }
    for (int a = first_arc_[h]; a < first_arc_[h + 1]; ++a) {
      const Arc& arc = arcs_[static_cast<std::size_t>(a)];
      const RoadEdge& edge = graph_.edges[static_cast<std::size_t>(arc.edge)];
      const DriveCost& drawn = arc.backwards ? edge.backwards : edge.forwards;
      spread.reach_heading(arc.to, {cost + arc.cost, heading, {&edge.track, arc.backwards, drawn}});
    }
  }
  return spread;
}

void WaySearch::start(int goal, const std::vector<Site>& sites, const GoalLinks& links,
                      Spread& spread) const {
  const Point2 begin = sites[static_cast<std::size_t>(goal)].depart.position();
  for (const DirectLink& link : links.direct) {
    if (link.from != goal) continue;
    const Point2 end = sites[static_cast<std::size_t>(link.to)].arrive.position();
    const double cost = std::max(0.0, reduced_cost(link.cost, begin, end));
    spread.reach_goal(link.to, {cost, -1, {&link.track, false, link.cost}});
  }
  for (const GoalLink& link : links.departures) {
    if (link.goal != goal) continue;
    const Point2 end = graph_.pose(link.heading).position();
    const double cost = std::max(0.0, reduced_cost(link.cost, begin, end));
    spread.reach_heading(link.heading, {cost, -1, {&link.track, false, link.cost}});
  }
}

GoalGraph::Edge WaySearch::way(const Spread& spread, int to) const {
  const Reached& arrived = spread.goals[static_cast<std::size_t>(to)];
  if (arrived.cost == kInfinity) return no_way();
  std::vector<const Leg*> legs{&arrived.leg};
  for (Heading h = arrived.from; h >= 0;) {
    const Reached& place = spread.headings[static_cast<std::size_t>(h)];
    legs.push_back(&place.leg);
    h = place.from;
  }
  GoalGraph::Edge edge;
  for (auto leg = legs.rbegin(); leg != legs.rend(); ++leg) {
    edge.cost += (*leg)->cost;
    edge.path.append((*leg)->track->path((*leg)->backwards));
  }
  return edge;
}

}  // namespace headland::internal
