// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/internal/free_ways.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include "core/geometry/reeds_shepp.hpp"
#include "global_planner/roadmap/hybrid_astar.hpp"
#include "global_planner/roadmap/roadmap.hpp"

namespace headland::mission {
namespace {

constexpr int kMostGoals = 100;     // of the roadmap; beyond, row ends are left to the lanes
constexpr double kLeadStep = 0.5;   // [m]
constexpr double kDetour = 1.5;     // over the shortest curve: from here on Hybrid A* is asked
constexpr double kNear = 60.0;      // [m] farther apart, it is not
constexpr int kExpansions = 20000;  // of one Hybrid A* search

// A site as open ground sees it: beyond the row's end, where the outline is clear of all rows.
struct Goal {
  int site = 0;
  double lead_out = 0.0;  // [m] straight on from the site
  double lead_in = 0.0;   // [m] straight into the site
  Site outside;
};

class FreeWays {
 public:
  FreeWays(const Mission& mission, const Vehicle& vehicle, Transitions& transitions)
      : mission_(mission),
        vehicle_(vehicle),
        transitions_(transitions),
        area_(open_ground(mission)),
        margin_(mission.config.planner.margin_m) {
    const int row_ends = 2 * static_cast<int>(mission.rows.size());
    const bool all = transitions.sites() <= kMostGoals;
    for (int site = all ? 0 : row_ends; site < transitions.sites(); ++site) {
      if (auto goal = goal_at(site)) goals_.push_back(*goal);
    }
  }

  Result<void> offer_roadmap() {
    const PlannerConfig& planner = mission_.config.planner;
    RoadmapOptions options;
    options.samples = planner.roadmap_samples;
    options.seed = planner.seed;
    options.margin_m = margin_;
    options.cache = planner.cache;
    const auto roadmap = Roadmap::build(area_, mission_.ground, vehicle_, options);
    if (!roadmap && roadmap.error().code == ErrorCode::kNoPath) return {};  // the lanes have to do
    if (!roadmap) return tl::unexpected<Error>(roadmap.error());
    std::vector<Site> sites;
    for (const Goal& goal : goals_) sites.push_back(goal.outside);
    const auto graph = roadmap->connect(sites, mission_.config.cost_weights());
    if (!graph) return tl::unexpected<Error>(graph.error());
    for (std::size_t a = 0; a < goals_.size(); ++a) {
      for (std::size_t b = 0; b < goals_.size(); ++b) {
        const GoalGraph::Edge& edge = graph->edge(static_cast<int>(a), static_cast<int>(b));
        if (a != b && !edge.path.empty()) offer(goals_[a], goals_[b], edge.path);
      }
    }
    return {};
  }

  void offer_hybrid() {
    HybridAstarOptions options;
    options.margin_m = margin_;
    options.max_expansions = kExpansions;
    const HybridAstar search(area_, vehicle_, options);
    const int row_ends = 2 * static_cast<int>(mission_.rows.size());
    for (const Goal& a : goals_) {
      for (const Goal& b : goals_) {
        // Rows are joined by headland turns; this is for places.
        if (a.site == b.site || (a.site < row_ends && b.site < row_ends)) continue;
        const Pose2& from = a.outside.depart;
        const Pose2& to = b.outside.arrive;
        if ((to.position() - from.position()).norm() > kNear) continue;
        const double shortest = shortest_reeds_shepp(from, to, vehicle_.turning_radius()).length();
        const DriveCost known = transitions_.cost(a.site, b.site);
        if (known.length_m <= kDetour * shortest + a.lead_out + b.lead_in) continue;
        if (const auto path = search.plan(from, to)) offer(a, b, *path);
      }
    }
  }

 private:
  // The drivable area without the bodies of rows.
  static Region open_ground(const Mission& mission) {
    std::vector<Polygon> bodies;
    for (const RowParcel& parcel : mission.farm.row_parcels) {
      for (const Row& row : parcel.rows) {
        const auto body = widen(row.line, parcel.row_spacing_m);
        bodies.insert(bodies.end(), body.begin(), body.end());
      }
    }
    const std::vector<Polygon> drivable = drivable_area(mission.farm);
    return Region(bodies.empty() ? drivable : subtract(drivable, bodies));
  }

  // How far straight on (sense 1) or back (-1) the outline is clear of all rows.
  std::optional<double> lead(const Pose2& from, double sense, double free_run) const {
    for (double lead = 0.0; lead <= free_run; lead += kLeadStep) {
      if (area_.contains(advance(from, 0.0, sense * lead), vehicle_.footprint, margin_)) {
        return lead;
      }
    }
    return std::nullopt;
  }

  std::optional<Goal> goal_at(int s) const {
    const Site& site = transitions_.site(s);
    const auto out = lead(site.depart, 1.0, transitions_.free_run(s, true));
    const auto in = lead(site.arrive, -1.0, transitions_.free_run(s, false));
    if (!out || !in) return std::nullopt;
    Goal goal{s, *out, *in, site};
    goal.outside.depart = advance(site.depart, 0.0, *out);
    goal.outside.arrive = advance(site.arrive, 0.0, -*in);
    return goal;
  }

  void offer(const Goal& a, const Goal& b, const Path& between) {
    Path path;
    path.append_straight(transitions_.site(a.site).depart, a.lead_out, 0);
    path.append(between);
    path.append_straight(b.outside.arrive, b.lead_in, 0);
    transitions_.offer(a.site, b.site, std::move(path));
  }

  const Mission& mission_;
  const Vehicle& vehicle_;
  Transitions& transitions_;
  Region area_;
  double margin_;
  std::vector<Goal> goals_;
};

}  // namespace

Result<void> offer_free_ways(const Mission& mission, const Vehicle& vehicle,
                             Transitions& transitions) {
  if (mission.farm.free_parcels.empty()) return {};
  FreeWays ways(mission, vehicle, transitions);
  if (mission.config.planner.roadmap_samples > 0) {
    if (auto done = ways.offer_roadmap(); !done) return done;
  }
  ways.offer_hybrid();
  return {};
}

}  // namespace headland::mission
