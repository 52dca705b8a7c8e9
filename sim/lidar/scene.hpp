// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/world/agent.hpp"
#include "core/world/farm.hpp"
#include "core/world/ground.hpp"
#include "sim/lidar/internal/world.hpp"
#include "sim/lidar/orchard.hpp"
#include "sim/lidar/ray.hpp"

namespace headland {

/// Pieces of a scan of real plants: points along a row (x, from 0 up), across it (y) and above the
/// ground (z) [m]; thinned to one point a few centimetres.
using CanopyStrip = std::vector<Eigen::Vector3f>;

/// The part of a scan within `half_width` [m] of the line through (offset across, heading) of its
/// own frame, as a strip: x along the heading from the first point up. Points below 0.2 m are
/// ground, and dropped; so are those that are not finite.
CanopyStrip cut_strip(std::span<const Eigen::Vector3f> points, double heading_rad, double offset_m,
                      double half_width_m);

/// A farm as rays see it: ground, grass, rows of plants with posts and wires, people and animals.
/// Same inputs and seed, same bytes. Copies share what does not move. Queries are thread-safe
/// beside each other. Beyond 60 m around the rows there is nothing.
class LidarScene {
 public:
  /// A farm's parcels: lines of plants stand half a spacing to either side of each row (rows are
  /// the middles of alleys), between neighbours once. Where the ground has no height, it goes on
  /// as high as beside. About 1 MB per kilometre of row.
  static LidarScene orchard(const Farm& farm, const Ground& ground, const OrchardConfig& config,
                            std::uint64_t seed);
  /// Straight rows, without a farm.
  static LidarScene rows(const RowLayout& layout, const OrchardConfig& config, std::uint64_t seed);
  /// Straight rows of real plants: strips follow each other along every row, picked and turned by
  /// chance. Of the config only grass and curvature count. `strips` empty: no plants.
  static LidarScene tiled(const RowLayout& layout, std::span<const CanopyStrip> strips,
                          const OrchardConfig& config, std::uint64_t seed);

  /// Those who are there now, in place of those before. Agents that are not finite are left out.
  void set_agents(std::span<const Agent> agents);
  const std::vector<Agent>& agents() const { return agents_; }

  /// What a ray meets first. About 1 us.
  RayHit trace(const Ray& ray) const { return world_->trace(ray, bodies_); }

  TerrainSample ground(const Point2& p_map) const { return world_->ground(p_map); }
  /// T_map_base of a vehicle that stands on the ground, tilted as the ground below it.
  Eigen::Isometry3d pose_on_ground(const Pose2& pose) const;
  /// Lines of plants as they were meant: with curvature, without jitter; a point per metre [m].
  const std::vector<Polyline>& plant_lines() const { return lines_; }
  /// Where plants stand [m]; empty in a tiled scene.
  const std::vector<Point2>& plants() const { return plants_; }
  /// Hash of all that does not move.
  std::uint64_t fingerprint() const { return world_->fingerprint(); }

 private:
  std::shared_ptr<const internal::World> world_;  // shared by copies
  std::vector<Polyline> lines_;
  std::vector<Point2> plants_;
  std::vector<Agent> agents_;
  internal::BodyIndex bodies_;  // of the agents
};

}  // namespace headland
