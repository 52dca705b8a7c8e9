// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/internal/goal_links.hpp"

#include <algorithm>
#include <utility>

namespace headland::internal {
namespace {

// Tried for a goal, and kept of them at most.
struct Effort {
  EdgeCurve curve;
  std::size_t nodes;
  std::size_t links;
};
constexpr Effort kEfforts[] = {{EdgeCurve::kClothoid, 48, 16}, {EdgeCurve::kDubins, 16, 12}};
constexpr std::size_t kNearGoals = 16;  // joined directly

template <class PositionOf>
std::vector<int> nearest(const Point2& p, int count, std::size_t most, PositionOf position_of) {
  std::vector<std::pair<double, int>> by_distance;
  for (int i = 0; i < count; ++i) by_distance.push_back({(position_of(i) - p).norm(), i});
  const auto kept = static_cast<std::ptrdiff_t>(std::min(most, by_distance.size()));
  std::partial_sort(by_distance.begin(), by_distance.begin() + kept, by_distance.end());
  std::vector<int> found;
  for (auto i = by_distance.begin(); i != by_distance.begin() + kept; ++i) {
    found.push_back(i->second);
  }
  return found;
}

class Linker {
 public:
  Linker(const RoadGraph& graph, const TrackMaker& tracks, double margin)
      : graph_(graph), tracks_(tracks), margin_(margin) {}

  void departures(int goal, const Pose2& pose, std::vector<GoalLink>& links) const {
    link(goal, pose, links, [&](const Pose2& node, EdgeCurve curve, double margin) {
      return drivable(pose, node, curve, margin);
    });
  }
  void arrivals(int goal, const Pose2& pose, std::vector<GoalLink>& links) const {
    link(goal, pose, links, [&](const Pose2& node, EdgeCurve curve, double margin) {
      return drivable(node, pose, curve, margin);
    });
  }
  std::optional<std::pair<Track, DriveCost>> direct(const Pose2& from, const Pose2& to) const {
    const double margin = std::min(margin_at(from), margin_at(to));
    auto way = drivable(from, to, EdgeCurve::kClothoid, margin);
    return way ? way : drivable(from, to, EdgeCurve::kDubins, margin);
  }

 private:
  // A goal may stand nearer to the edge than other places.
  double margin_at(const Pose2& pose) const { return tracks_.fits(pose, margin_) ? margin_ : 0.0; }

  std::optional<std::pair<Track, DriveCost>> drivable(const Pose2& from, const Pose2& to,
                                                      EdgeCurve curve, double margin) const {
    const auto track = tracks_.join(from, to, curve);
    if (!track || !tracks_.open_ways(*track, margin, {true, false}).forwards) return std::nullopt;
    const auto cost = tracks_.cost(*track);
    if (!cost) return std::nullopt;
    return std::pair(*track, *cost);
  }

  template <class Drive>
  void link(int goal, const Pose2& pose, std::vector<GoalLink>& links, Drive drive) const {
    const double margin = margin_at(pose);
    for (const Effort& effort : kEfforts) {
      const auto near = nearest(pose.position(), static_cast<int>(graph_.nodes.size()),
                                effort.nodes, [&](int i) { return graph_.pose(2 * i).position(); });
      const std::size_t most = links.size() + effort.links;
      for (const int node : near) {
        for (const Heading heading : {2 * node, 2 * node + 1}) {
          if (links.size() >= most) break;
          if (auto way = drive(graph_.pose(heading), effort.curve, margin)) {
            links.push_back({goal, heading, way->first, way->second});
          }
        }
      }
    }
  }

  const RoadGraph& graph_;
  const TrackMaker& tracks_;
  double margin_;
};

}  // namespace

GoalLinks link_goals(const std::vector<Site>& goals, const RoadGraph& graph,
                     const TrackMaker& tracks, double margin) {
  const Linker linker(graph, tracks, margin);
  GoalLinks links;
  const int count = static_cast<int>(goals.size());
  for (int i = 0; i < count; ++i) {
    const Site& goal = goals[static_cast<std::size_t>(i)];
    linker.departures(i, goal.depart, links.departures);
    linker.arrivals(i, goal.arrive, links.arrivals);
    const auto near = nearest(goal.depart.position(), count, kNearGoals + 1, [&](int k) {
      return goals[static_cast<std::size_t>(k)].arrive.position();
    });
    for (const int k : near) {
      if (k == i) continue;
      const auto way = linker.direct(goal.depart, goals[static_cast<std::size_t>(k)].arrive);
      if (way) links.direct.push_back({i, k, way->first, way->second});
    }
  }
  return links;
}

}  // namespace headland::internal
