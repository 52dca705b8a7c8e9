// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/pose2.hpp"

namespace headland {

/// Where someone was seen of late, so that a predictor can look back at equal steps although sights
/// come when they come. Holds the newest sight and, of those before, one per 0.05 s, 96 in all.
class SightHistory {
 public:
  struct Sight {
    double time_s = 0.0;
    Point2 position{0.0, 0.0};  ///< [m]
    Point2 velocity{0.0, 0.0};  ///< [m/s]
  };

  void clear() { size_ = 0; }
  bool empty() const { return size_ == 0; }
  /// Requires a time not before that of the newest sight; one at the same time replaces it.
  void add(const Sight& sight);
  /// Requires that there is one.
  const Sight& oldest() const { return sights_[slot(0)]; }
  const Sight& newest() const { return sights_[slot(size_ - 1)]; }
  /// At a time, linear between two sights, the newest after that; false before the oldest.
  bool at(double time_s, Sight& sight) const;

 private:
  static constexpr std::size_t kRoom = 96;
  std::size_t slot(std::size_t i) const { return (first_ + i) % kRoom; }

  std::vector<Sight> sights_ = std::vector<Sight>(kRoom);  // a ring
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace headland
