// SPDX-License-Identifier: Apache-2.0
#include "sim/crowd/sight.hpp"

#include <algorithm>

namespace headland {

void see_agents(std::span<const Agent> agents, const Point2& here, double view_m,
                double noise_ratio, RandomStream& noise, std::vector<Agent>& seen) {
  seen.clear();
  for (Agent agent : agents) {
    const double distance = (agent.position - here).norm();
    if (distance > view_m) continue;
    const double sigma = noise_ratio * distance;
    agent.noise_m = std::max(0.01, sigma);
    const double north = sigma * noise.normal();
    const double east = sigma * noise.normal();
    agent.position += Point2(east, north);
    seen.push_back(agent);
  }
}

}  // namespace headland
