// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/pose2.hpp"

namespace headland {

/// Someone near: how far away, squared [m2], and where in the list of points.
struct Near {
  double distance2 = 0.0;
  int index = 0;
  bool operator<(const Near& other) const {
    return distance2 < other.distance2 || (distance2 == other.distance2 && index < other.index);
  }
};

/// Finds the nearest of many points: a balanced k-d tree whose nodes know the box around their
/// points. Exact; equally near points count in the order of the list. Points must be finite.
class Nearest {
 public:
  /// O(n log n); does not allocate once it has held as many points.
  void build(std::span<const Point2> points);
  /// The `most` nearest points less than `range` [m] from `point`, nearest first, without that of
  /// index `self`. `near` is overwritten; no allocation if its capacity is `most`.
  void find(const Point2& point, int self, double range, std::size_t most,
            std::vector<Near>& near) const;

 private:
  struct Item {
    double x = 0.0;
    double y = 0.0;
    int index = 0;
  };
  struct Node {
    double low_x = 0.0, low_y = 0.0, high_x = 0.0, high_y = 0.0;
    int begin = 0;  // of its items
    int end = 0;
    int right = 0;  // its second child; the first follows it; 0: a leaf
    double distance2(double x, double y) const;
  };
  void split(int begin, int end);

  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

}  // namespace headland
