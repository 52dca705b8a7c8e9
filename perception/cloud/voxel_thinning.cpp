// SPDX-License-Identifier: Apache-2.0
#include "perception/cloud/voxel_thinning.hpp"

#include <bit>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace headland {
namespace {

constexpr float kMostVoxels = 1e6f;  // each way: a coordinate takes 21 bits
constexpr int kBits = 21;

std::uint64_t voxel_index(float scaled) {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(scaled)) +
                                    (std::int64_t{1} << (kBits - 1)));
}

}  // namespace

VoxelThinning::VoxelThinning(double voxel) : per_metre_(static_cast<float>(1.0 / voxel)) {
  if (!(voxel > 0.0) || !std::isfinite(per_metre_)) {
    throw std::invalid_argument(fmt::format("voxel is {} m; it must be positive", voxel));
  }
}

VoxelThinning::Slot& VoxelThinning::slot_of(std::uint64_t key) {
  const std::size_t mask = slots_.size() - 1;
  std::uint64_t hash = key * 0x9e3779b97f4a7c15u;  // Fibonacci hashing (Knuth)
  hash ^= hash >> 32;
  std::size_t at = hash & mask;
  while (slots_[at].call == call_ && slots_[at].key != key) at = (at + 1) & mask;
  return slots_[at];
}

void VoxelThinning::thin(std::span<const LidarPoint> points, std::vector<LidarPoint>& out) {
  const std::size_t wanted = std::bit_ceil(2 * points.size() + 1);
  if (slots_.size() < wanted || ++call_ == 0) {
    slots_.assign(std::max(wanted, slots_.size()), Slot{});
    call_ = 1;
  }
  out.clear();
  out.reserve(points.size());
  counts_.clear();
  counts_.reserve(points.size());
  for (const LidarPoint& point : points) {
    const Eigen::Vector3f scaled = point.position * per_metre_;
    if (!(scaled.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() < kMostVoxels)) continue;
    const std::uint64_t key = (voxel_index(scaled.x()) << (2 * kBits)) |
                              (voxel_index(scaled.y()) << kBits) | voxel_index(scaled.z());
    Slot& slot = slot_of(key);
    if (slot.call != call_) {
      slot = {key, call_, static_cast<std::int32_t>(out.size())};
      out.push_back(point);
      counts_.push_back(1.0f);
      continue;
    }
    const auto index = static_cast<std::size_t>(slot.point);
    const float share = 1.0f / (counts_[index] += 1.0f);
    out[index].position += share * (point.position - out[index].position);
    out[index].intensity += share * (point.intensity - out[index].intensity);
  }
}

}  // namespace headland
