// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/base/error.hpp"
#include "global_planner/tour/internal/model.hpp"

namespace headland::tour {

/// Why no vehicle can do a task even if it does nothing else; nothing if one can. `what` begins
/// with "task N: " and, where the battery is too small, ends with the energy that is missing.
std::optional<Error> why_impossible(const Model& model, int task);

}  // namespace headland::tour
