// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "apps/report.hpp"
#include "core/world/agent.hpp"

namespace headland::apps {

/// Who was where at a moment.
struct AgentsAt {
  double time_s = 0.0;
  std::span<const Agent> agents;
};

/// The tracks of all agents over sights at equal periods. Who goes out of sight and comes back is
/// somebody else.
ReportAgents agent_tracks(std::span<const AgentsAt> sights);

}  // namespace headland::apps
