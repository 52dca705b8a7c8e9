// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "perception/localization/internal/cell_key.hpp"

namespace headland::internal {

/// Replaces the points in each cell by their mean, in the order of each cell's first point. O(n);
/// does not allocate once it has seen as many points.
class Thinner {
 public:
  void thin(std::span<const Eigen::Vector3f> points, float cell_m,
            std::vector<Eigen::Vector3f>& out) {
    std::size_t size = 1024;
    while (size < 2 * points.size()) size *= 2;
    if (slots_.size() < size) slots_.assign(size, {});
    const std::size_t mask = slots_.size() - 1;
    ++stamp_;
    out.clear();
    counts_.clear();
    for (const Eigen::Vector3f& point : points) {
      const std::uint64_t key = cell_key(cell_of(point, 1.0f / cell_m));
      std::size_t at = slot_of(key, mask);
      while (slots_[at].stamp == stamp_ && slots_[at].key != key) at = (at + 1) & mask;
      if (slots_[at].stamp != stamp_) {
        slots_[at] = {key, stamp_, static_cast<std::uint32_t>(out.size())};
        out.push_back(point);
        counts_.push_back(1.0f);
      } else {
        out[slots_[at].index] += point;
        counts_[slots_[at].index] += 1.0f;
      }
    }
    for (std::size_t i = 0; i < out.size(); ++i) out[i] /= counts_[i];
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t stamp = 0;
    std::uint32_t index = 0;
  };
  std::vector<Slot> slots_;
  std::vector<float> counts_;
  std::uint32_t stamp_ = 0;
};

}  // namespace headland::internal
