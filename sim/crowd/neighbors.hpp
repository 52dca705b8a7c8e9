// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/pose2.hpp"

namespace headland {

/// A neighbour: how far away, squared [m2], and where in the list of points.
struct Neighbor {
  double distance2 = 0.0;
  int index = 0;
  bool operator<(const Neighbor& other) const {
    return distance2 < other.distance2 || (distance2 == other.distance2 && index < other.index);
  }
};

/// The nearest neighbours of each of many points that move from call to call. Exact; equally near
/// ones count in the order of the list. By a balanced k-d tree of small leaves, so neither spread
/// nor crowding matter; where neighbours are from call to call the same, they bound the search.
class Neighbors {
 public:
  /// Of each point the `most` nearest others less than `range` [m] away. Points must be finite.
  /// O(n log n); does not allocate once it has held as many points and neighbours.
  void update(std::span<const Point2> points, double range, std::size_t most);
  /// Those of a point, nearest first.
  std::span<const Neighbor> of(std::size_t point) const {
    return {neighbors_.data() + point * most_, counts_[point]};
  }

 private:
  struct Item {
    double x = 0.0;
    double y = 0.0;
    int index = 0;
  };
  struct Node {
    double low_x = 0.0, low_y = 0.0, high_x = 0.0, high_y = 0.0;  // the box around its items
    int begin = 0;                                                // of its items
    int end = 0;
    int right = 0;  // its second child, the first follows it; 0: a leaf
  };
  void split(int begin, int end);
  double bound2(std::span<const Point2> points, std::size_t point) const;
  void gather(const Node& leaf, double reach2, std::size_t node);
  void search(const Item& item, double limit2);

  double range2_ = 0.0;
  std::size_t most_ = 0;
  std::vector<Item> items_;
  std::vector<Node> nodes_;
  std::vector<const Node*> around_;  // leaves near the one at hand
  std::vector<double> bounds2_;      // of the leaf's items
  std::vector<Neighbor> found_;      // of the item at hand
  std::vector<Neighbor> neighbors_;  // most_ places a point
  std::vector<std::size_t> counts_;
};

}  // namespace headland
