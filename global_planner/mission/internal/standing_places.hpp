// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "global_planner/mission/mission_config.hpp"

namespace headland::mission {

/// Every vehicle has to fit, and to find ground under it, where it starts, ends, charges and is to
/// visit, and all along the mission's rows: an Error that names the first place where its outline
/// leaves the drivable area or enters a keep-out, or where the terrain has no height.
std::optional<Error> check_standing_places(const Mission& mission);

}  // namespace headland::mission
