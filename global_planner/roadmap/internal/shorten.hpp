// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "global_planner/roadmap/internal/drive_rules.hpp"
#include "global_planner/roadmap/internal/outline_fit.hpp"

namespace headland::roadmap {

/// A path that costs no more: stretches of it give way to Dubins or Reeds-Shepp curves that fit and
/// are cheaper, until none is. Same start, same end. Deterministic.
Path shortened(const Path& path, const DriveRules& rules, const OutlineFit& fit);

}  // namespace headland::roadmap
