// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/roadmap.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "global_planner/roadmap/internal/goal_links.hpp"
#include "global_planner/roadmap/internal/prm.hpp"
#include "global_planner/roadmap/internal/roadmap_cache.hpp"
#include "global_planner/roadmap/internal/way_search.hpp"

namespace headland {

struct Roadmap::Impl {
  Impl(const Region& region, const Ground& its_ground, const Vehicle& its_vehicle,
       const RoadmapOptions& its_options)
      : drivable(region),
        ground(its_ground),
        vehicle(its_vehicle),
        options(its_options),
        tracks(drivable, ground, vehicle, options.curve) {}

  Region drivable;
  Ground ground;
  Vehicle vehicle;
  RoadmapOptions options;
  internal::TrackMaker tracks;  // of the members above
  internal::RoadGraph graph;
  bool from_cache = false;
};

Roadmap::Roadmap(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Roadmap::~Roadmap() = default;
Roadmap::Roadmap(Roadmap&&) noexcept = default;
Roadmap& Roadmap::operator=(Roadmap&&) noexcept = default;

Result<Roadmap> Roadmap::build(const Region& drivable, const Ground& ground, const Vehicle& vehicle,
                               const RoadmapOptions& options) {
  auto impl = std::make_unique<Impl>(drivable, ground, vehicle, options);
  const internal::RoadmapCache cache(drivable, ground, vehicle, options);
  if (auto known = cache.load()) impl->graph = *std::move(known);
  impl->from_cache = impl->graph.samples >= options.samples;
  if (!impl->from_cache) {
    internal::grow(impl->graph, impl->tracks, options.samples, options.seed, options.margin_m);
    cache.store(impl->graph);
  }
  impl->graph.cut(options.samples);
  if (impl->graph.nodes.empty()) {
    return fail(ErrorCode::kNoPath,
                fmt::format("vehicle '{}' fits nowhere in {:.0f} m2 of drivable area", vehicle.name,
                            drivable.area()),
                "a smaller outline or margin, gentler slopes, or more area");
  }
  return Roadmap(std::move(impl));
}

bool Roadmap::from_cache() const { return impl_->from_cache; }
int Roadmap::nodes() const { return static_cast<int>(impl_->graph.nodes.size()); }

int Roadmap::edges() const {
  int count = 0;
  for (const internal::RoadEdge& edge : impl_->graph.edges) {
    count += (edge.open.forwards ? 1 : 0) + (edge.open.backwards ? 1 : 0);
  }
  return count;
}

std::vector<Path> Roadmap::edge_paths() const {
  std::vector<Path> paths;
  for (const internal::RoadEdge& edge : impl_->graph.edges) {
    if (edge.open.forwards) paths.push_back(edge.track.path());
    if (edge.open.backwards) paths.push_back(edge.track.path(true));
  }
  return paths;
}

Result<GoalGraph> Roadmap::connect(const std::vector<Site>& goals,
                                   const CostWeights& objective) const {
  const internal::GoalLinks links =
      internal::link_goals(goals, impl_->graph, impl_->tracks, impl_->options.margin_m);
  const internal::WaySearch search(impl_->graph, impl_->tracks, impl_->vehicle, objective);
  return search.ways(goals, links);
}

}  // namespace headland
