// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/config/visit.hpp"

namespace headland {

struct VoxelMapConfig {
  double cell_m = 0.5;
  double noise_m = 0.03;
  double radius_m = 60.0;
  int most_count = 150000;

  template <class V>
  void visit(V& v) {
    v("cell_m", cell_m, config::Range{0.05, 10.0}, "Edge of a voxel [m]");
    v("noise_m", noise_m, config::kPositive, "Of a point across a surface [m]");
    v("radius_m", radius_m, config::kPositive, "Voxels farther away are forgotten [m]");
    v("most_count", most_count, config::Range{1000.0, 1e7},
      "Voxels kept; beyond that those not seen for longest are forgotten");
  }
};

/// The points of one cell, as a Gaussian.
struct Voxel {
  Eigen::Vector3f mean{0.0f, 0.0f, 0.0f};  ///< [m]
  /// What a point near it says about its place [1/m2]: the inverse covariance, across a surface or
  /// a trunk only; along them, and in a cell that is filled, it says nothing.
  Eigen::Matrix3f information = Eigen::Matrix3f::Zero();
  bool informative = false;
  int count = 0;
};

/// A map of voxels with Gaussians (after NDT and VGICP), sparse, by hash.
///
/// Only shapes that a lidar with few rings cannot make up are informative: a plane needs an extent
/// in two directions, a line counts only where it stands upright (trunk, post), since an arc that
/// one ring draws on the ground looks like a line too. Deterministic. Reads are thread-safe. insert
/// and find are O(1); does not allocate after construction.
class VoxelMap {
 public:
  explicit VoxelMap(const VoxelMapConfig& config);

  void insert(const Eigen::Vector3f& point);
  /// The voxel at a point, or null.
  const Voxel* find(const Eigen::Vector3f& point) const;
  /// The voxel at a point if it is informative, else the nearest informative one that shares a face
  /// with its cell, or null.
  const Voxel* find_informative(const Eigen::Vector3f& point) const;

  /// Forgets what lies farther than the radius from `centre`, and of too many voxels those not seen
  /// for longest. To be called after each scan: it counts them, and works when `centre` has moved
  /// by a tenth of the radius, or the map is nearly full. O(voxels).
  void end_scan(const Eigen::Vector3f& centre);

  int size() const { return static_cast<int>(voxels_.size()); }
  void clear();

 private:
  struct Entry {
    Voxel voxel;
    std::uint64_t key = 0;
    Eigen::Vector3f centre{0.0f, 0.0f, 0.0f};
    Eigen::Vector3f sum{0.0f, 0.0f, 0.0f};              // about the centre
    Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();  // likewise
    int shape_due = 0;                                  // at this count the shape is found again
    int last_scan = 0;
  };
  std::size_t slot(std::uint64_t key) const;
  void find_shape(Entry& entry) const;
  void forget(const Eigen::Vector3f& centre);

  VoxelMapConfig config_;
  float per_metre_;
  std::vector<Entry> voxels_;
  std::vector<int> table_;  // index into voxels_, or -1
  std::vector<int> ages_;
  int scan_ = 0;
  Eigen::Vector3f forgot_at_{0.0f, 0.0f, 0.0f};
};

}  // namespace headland
