// SPDX-License-Identifier: Apache-2.0
#include "local_planner/outline.hpp"

namespace headland {

OutlineDiscs::OutlineDiscs(const Footprint& outline, double excess) {
  // A disc that covers a piece of length l reaches sqrt(w^2 + l^2) / 2 to the side.
  const double length = outline.front_m + outline.rear_m;
  const double half = 0.5 * outline.width_m;
  const double piece = 2.0 * std::sqrt(excess * (2.0 * half + excess));
  const int count = std::max(1, static_cast<int>(std::ceil(length / piece)));
  const double step = length / count;
  radius_ = std::hypot(0.5 * step, half);
  for (int i = 0; i < count; ++i) ahead_.push_back(-outline.rear_m + (i + 0.5) * step);
}

}  // namespace headland
