// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/world/lidar.hpp"

namespace headland {

/// One point per cubic voxel: the mean position and intensity of its points, the ring and time of
/// the first of them.
class VoxelThinning {
 public:
  /// `voxel` [m] > 0, else std::invalid_argument.
  explicit VoxelThinning(double voxel);

  /// Points in the order in which their voxels are first met; those that are not finite, or more
  /// than a million voxels from the origin, are left out. Overwrites `out`, which must not be
  /// `points`. O(n), about 50 ns a point; does not allocate once it has held as many points.
  void thin(std::span<const LidarPoint> points, std::vector<LidarPoint>& out);

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t call = 0;  // in which the slot was filled
    std::int32_t point = 0;  // its index in the output
  };
  Slot& slot_of(std::uint64_t key);

  float per_metre_;
  std::uint32_t call_ = 0;
  std::vector<Slot> slots_;  // open addressing; a power of two, at least twice the points
  std::vector<float> counts_;
};

}  // namespace headland
