// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/geometry/pose2.hpp"

namespace headland {

/// The nearest others of each of a set of points. For the tens of agents near a robot comparing
/// all pairs is the fastest.
class NearestAgents {
 public:
  /// The `most` nearest of each, less than `range` [m] away. O(n^2), about 1 ns per pair; does not
  /// allocate once it has held as many.
  void find(std::span<const Point2> points, int most, double range);
  /// Indices of the nearest of a point, nearest first.
  std::span<const int> of(std::size_t point) const {
    return {near_.data() + begin_[point], near_.data() + begin_[point + 1]};
  }

 private:
  std::vector<int> near_;
  std::vector<std::size_t> begin_;
  std::vector<std::pair<double, int>> found_;  // squared distance and index
};

}  // namespace headland
