// SPDX-License-Identifier: Apache-2.0
#include "apps/agent_tracks.hpp"

#include <cstddef>
#include <map>

namespace headland::apps {

ReportAgents agent_tracks(std::span<const AgentsAt> sights) {
  ReportAgents agents;
  if (sights.size() < 2) return agents;
  agents.start_s = sights[0].time_s;
  agents.period_s = sights[1].time_s - sights[0].time_s;
  std::map<int, std::size_t> last;  // track of an id
  for (std::size_t k = 0; k < sights.size(); ++k) {
    for (const Agent& agent : sights[k].agents) {
      const auto known = last.find(agent.id);
      const bool goes_on = known != last.end() && [&] {
        const ReportAgent& track = agents.tracks[known->second];
        return static_cast<std::size_t>(track.first) + track.positions.size() == k;
      }();
      if (!goes_on) {
        last[agent.id] = agents.tracks.size();
        agents.tracks.push_back({agent.radius_m, static_cast<int>(k)});
      }
      agents.tracks[last[agent.id]].positions.push_back(agent.position);
    }
  }
  return agents;
}

}  // namespace headland::apps
