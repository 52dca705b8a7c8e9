// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "core/base/result.hpp"

namespace headland {

/// The cheapest round tour from place 0 through places 1 .. count - 1, in the order of visits
/// without place 0; `cost(from, to)` may be infinite. Errors as solve_tour.
Result<std::vector<int>> round_tour(int count, const std::function<double(int, int)>& cost);

}  // namespace headland
