// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/region.hpp"
#include "core/model/vehicle.hpp"
#include "core/world/ground.hpp"
#include "global_planner/roadmap/goal_graph.hpp"

namespace headland {

enum class EdgeCurve { kClothoid, kDubins };

struct RoadmapOptions {
  int samples = 2000;
  std::uint64_t seed = 1;
  EdgeCurve curve = EdgeCurve::kClothoid;
  double margin_m = 0.1;  ///< kept between the outline and the edge of the drivable area
  /// Folder of cache files; empty: none. The file's name is a hash of everything the roadmap
  /// depends on (area, terrain, soil, vehicle, options, format version).
  std::filesystem::path cache;
};

/// An energy-weighted probabilistic roadmap over (x, y, heading): OMPL's PRM, whose edges are
/// curvature-bounded clothoids or Dubins curves along which the outline fits and the slopes are
/// within the vehicle's limits (003, III-A). Built once for an area, ground and vehicle.
class Roadmap {
 public:
  /// Errors: kNoPath if no sample fits.
  static Result<Roadmap> build(const Region& drivable, const Ground& ground, const Vehicle& vehicle,
                               const RoadmapOptions& options = {});
  ~Roadmap();
  Roadmap(Roadmap&&) noexcept;
  Roadmap& operator=(Roadmap&&) noexcept;

  bool from_cache() const;
  int nodes() const;
  int edges() const;
  /// The roadmap's edges, for checks and pictures.
  std::vector<Path> edge_paths() const;
  /// Joins the goals to the roadmap (and to each other where near) and finds the cheapest ways
  /// between all pairs by the objective; edges may be negative (recuperation), searched with
  /// potentials. Where there is no way, the edge's cost is infinite.
  Result<GoalGraph> connect(const std::vector<Site>& goals,
                            const CostWeights& objective = Objective::kEnergy) const;

 private:
  struct Impl;
  explicit Roadmap(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::EdgeCurve> {
  static constexpr std::pair<headland::EdgeCurve, std::string_view> values[] = {
      {headland::EdgeCurve::kClothoid, "clothoid"}, {headland::EdgeCurve::kDubins, "dubins"}};
};
