// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/polygon.hpp"
#include "sim/lidar/internal/world.hpp"
#include "sim/lidar/orchard.hpp"

namespace headland::internal {

/// A place on a line of plants.
struct Station {
  double s = 0.0;  ///< along the line from its start [m]
  Point2 position{0.0, 0.0};
  Point2 left{0.0, 1.0};  ///< unit vector
};

/// Stations `step` [m] apart along the line, swung by the config's curvature.
std::vector<Station> stations(const Polyline& line, double step, const OrchardConfig& config);

/// Sets plants, posts and wires along a line, and its canopy. Returns where plants stand.
class Planter {
 public:
  Planter(World& world, const OrchardConfig& config, std::uint64_t seed);

  /// A row with a canopy of the config's own making.
  void plant(const Polyline& line);
  /// A row whose plants are cut from a scan: strips of points along the row (x), across it (y) and
  /// above the ground (z), one after the other, each picked and turned by chance.
  void tile(const Polyline& line, std::span<const std::vector<Eigen::Vector3f>> strips);
  const std::vector<Point2>& plants() const { return plants_; }

 private:
  void set_plants(const std::vector<Station>& row);
  void set_posts(const std::vector<Station>& row);
  void set_wires(const Point2& from, const Point2& to);
  void set_canopy(const std::vector<Station>& row);
  double density(double s, double across, double z, double outline) const;
  void fill(const Point2& p, double z, double area_density);

  World& world_;
  OrchardConfig config_;
  RandomStream places_;
  RandomStream leaves_;
  RandomStream tiles_;
  std::vector<Point2> plants_;
  std::vector<bool> alive_;  // of the present row, by slot of trunk_pitch_m
};

/// Heights of grass, smooth over a few voxels, for World::set_grass.
std::vector<float> grass_heights(const OrchardConfig& config, std::uint64_t seed);

}  // namespace headland::internal
