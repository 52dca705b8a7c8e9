// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/nearest_agents.hpp"

#include <algorithm>

namespace headland {

void NearestAgents::find(std::span<const Point2> points, int most, double range) {
  near_.clear();
  begin_.assign(1, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    found_.clear();
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double distance2 = (points[j] - points[i]).squaredNorm();
      if (j != i && distance2 < range * range) found_.emplace_back(distance2, static_cast<int>(j));
    }
    const auto end = found_.begin() + std::clamp<std::ptrdiff_t>(most, 0, std::ssize(found_));
    std::partial_sort(found_.begin(), end, found_.end());
    for (auto it = found_.begin(); it != end; ++it) near_.push_back(it->second);
    begin_.push_back(near_.size());
  }
}

}  // namespace headland
