// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/polygon.hpp"
#include "core/geometry/pose2.hpp"
#include "core/world/terrain.hpp"
#include "sim/lidar/ray.hpp"

namespace headland::internal {

/// A capsule: all points within `radius` of the segment from `a` to `b`. x, y in `map`, z above the
/// ground [m].
struct Body {
  Eigen::Vector3d a{0.0, 0.0, 0.0};
  Eigen::Vector3d b{0.0, 0.0, 0.0};
  double radius = 0.0;
  Surface surface = Surface::kTrunk;
  int agent = -1;  ///< index of the agent that it is part of
};

/// Bodies by the blocks that they touch.
struct BodyIndex {
  std::vector<Body> bodies;
  std::vector<std::int32_t> head;                            ///< by block: its first link, -1: none
  std::vector<std::pair<std::int32_t, std::int32_t>> links;  ///< body, next link

  void clear(int blocks);
  void add(std::int32_t block, std::int32_t body);
};

/// Ground, bodies and porous volumes on a grid of blocks, each of kSide x kSide columns of voxels.
/// Within a block, heights above the ground are taken to change evenly along a ray.
class World {
 public:
  static constexpr double kVoxel = 0.2;  // [m]
  static constexpr int kSide = 8;        // columns per side of a block
  static constexpr double kBlock = kVoxel * kSide;
  static constexpr double kDensityStep = 0.05;  // of a stored density [m2/m3]

  /// `height`: of the ground [m]. `top`: no voxel lies higher above the ground [m].
  World(const MapBox& box, double top, const std::function<double(const Point2&)>& height);

  void set_grass(std::vector<float> heights, double area_density);  ///< kGrassSide squared [m]
  void add(const Body& body) { insert(body, fixed_); }
  /// Takes the body into an index of this world.
  void insert(const Body& body, BodyIndex& index) const;
  /// Density [m2/m3] of the voxel around (x, y) in `map` and z above the ground; null off the grid.
  std::uint8_t* voxel(const Point2& p, double z);

  int blocks() const { return columns_ * rows_; }
  TerrainSample ground(const Point2& p) const;
  std::uint64_t fingerprint() const;
  RayHit trace(const Ray& ray, const BodyIndex& moving) const;

  static constexpr int kGrassSide = 64;

 private:
  // A ray within one block: at t it is at (x0 + dx t, y0 + dy t, h0 + dh t), the last above ground.
  struct Piece {
    Eigen::Vector3d start;
    Eigen::Vector3d step;
    double begin = 0.0;
    double end = 0.0;
    int column = 0;
    int row = 0;
    double height(double t) const { return start.z() + step.z() * t; }
  };

  struct Stretch {
    double begin = 0.0;
    double end = 0.0;
  };
  std::optional<Stretch> stretch(const Ray& ray) const;

  int block(int column, int row) const { return row * columns_ + column; }
  float corner(int column, int row) const {
    return corners_[static_cast<std::size_t>(row * (columns_ + 1) + column)];
  }
  double height_in(int column, int row, double x, double y) const;
  bool hit_in(const Ray& ray, const BodyIndex& moving, Piece& piece, double& depth,
              RayHit& hit) const;
  void hit_bodies(const Ray& ray, const BodyIndex& index, Piece& piece, RayHit& hit) const;
  bool hit_porous(const Piece& piece, double& depth, RayHit& hit) const;
  double grass_at(const Piece& piece, int column, int row) const;

  Point2 origin_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  int layers_ = 0;
  bool flat_ = true;
  double highest_ = 0.0;              // of ground and all that stands on it, in map
  double tallest_ = 0.0;              // of all that stands on the ground
  std::vector<float> corners_;        // heights of the ground
  std::vector<std::int32_t> volume_;  // by block: first voxel in voxels_, -1: none
  std::vector<std::uint8_t> voxels_;  // by layer, row, column
  std::vector<float> grass_;          // heights, repeated over the map
  double grass_top_ = 0.0;
  double grass_rate_ = 0.0;  // optical depth per metre
  BodyIndex fixed_;
};

}  // namespace headland::internal
