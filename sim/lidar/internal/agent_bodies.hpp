// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/world/agent.hpp"
#include "sim/lidar/internal/world.hpp"

namespace headland::internal {

/// An agent as capsules: people upright, 1.7 m tall; animals along their way, on four legs;
/// vehicles as a hood. None if a number of it is not finite or its radius is not positive.
std::vector<Body> bodies_of(const Agent& agent, int index);

/// Height of an agent of that kind [m].
double height_of(const Agent& agent);

}  // namespace headland::internal
