// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/random.hpp"
#include "core/world/agent.hpp"

namespace headland {

/// The agents within `view_m` [m] of `here`, each off by white noise of `noise_ratio` times its
/// distance in x and in y; noise_m says so, and is never below 1 cm. In the order of `agents`.
void see_agents(std::span<const Agent> agents, const Point2& here, double view_m,
                double noise_ratio, RandomStream& noise, std::vector<Agent>& seen);

}  // namespace headland
