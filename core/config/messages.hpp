// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/config/visit.hpp"

namespace headland::config {

/// "must be greater than 0", "allowed: 0 to 1", ...
std::string allowed(Range range);

/// "did you mean 'row_spacing_m'?" where a known name is near, or else "allowed: a, b, c".
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

}  // namespace headland::config
