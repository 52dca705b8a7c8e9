// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/run/field_agents.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace headland {
namespace {

constexpr int kTries = 1000;        // for a place apart from all vehicles
constexpr double kCell = 0.2;       // of the map of obstacles [m] ...
constexpr double kMostCells = 4e6;  // ... unless the farm is large

// The parcel of that id, as far as it is drivable; all that is drivable for an empty id.
Result<std::vector<Polygon>> area_of(const std::string& parcel, const Farm& farm) {
  std::vector<Polygon> drivable = drivable_area(farm);
  if (parcel.empty()) return drivable;
  for (const RowParcel& rows : farm.row_parcels) {
    if (rows.id == parcel) return intersect({rows.boundary}, drivable);
  }
  for (const FreeParcel& free : farm.free_parcels) {
    if (free.id == parcel) return intersect({free.boundary}, drivable);
  }
  return tl::unexpected<Error>({ErrorCode::kUnknownName,
                                fmt::format("the farm has no parcel '{}'", parcel),
                                "name a row or free parcel of the farm, or leave it out",
                                {{}, 0, "simulation.agents.groups"}});
}

// A place in the area that is apart from all starts.
std::optional<Point2> place_for(const CrowdAgent& agent, const GoalRule& anywhere,
                                std::span<const Point2> starts, double apart,
                                RandomStream& random) {
  for (int i = 0; i < kTries; ++i) {
    const std::optional<Point2> p = anywhere(agent, random);
    if (!p) return std::nullopt;
    if (std::all_of(starts.begin(), starts.end(),
                    [&](const Point2& start) { return (start - *p).norm() >= apart; })) {
      return p;
    }
  }
  return std::nullopt;
}

// The line without its first `cut` [m], turned round: twice, and both ends are cut. Empty if it is
// shorter than that.
Polyline shortened(const Polyline& line, double cut) {
  Polyline rest;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double piece = (line[i + 1] - line[i]).norm();
    if (rest.empty() && piece > cut) {
      rest.push_back(line[i] + (cut / piece) * (line[i + 1] - line[i]));
    }
    if (rest.empty()) {
      cut -= piece;
    } else {
      rest.push_back(line[i + 1]);
    }
  }
  std::reverse(rest.begin(), rest.end());
  return rest;
}

Error no_place(const AgentGroupConfig& group) {
  return {ErrorCode::kOutOfRange,
          fmt::format("no place for {} of a group in '{}'", group.count, group.parcel),
          "a larger parcel, a smaller apart_m",
          {{}, 0, "simulation.agents.groups"}};
}

}  // namespace

std::optional<Error> AgentGroupConfig::check() const {
  if (behaviour == Behaviour::kReplay) {
    return Error{ErrorCode::kUnsupported,
                 "recorded agents have no recording here",
                 "choose orca, orca_blind, ignore or herd",
                 {{}, 0, "behaviour"}};
  }
  return std::nullopt;
}

bool FieldAgentsConfig::anyone() const {
  return std::any_of(groups.begin(), groups.end(),
                     [](const AgentGroupConfig& group) { return group.count > 0; });
}

Result<Crowd> make_crowd(const FieldAgentsConfig& config, const Farm& farm,
                         std::span<const Point2> starts, std::uint64_t seed) {
  RandomStream random(seed, "run/agents");
  std::vector<CrowdAgent> agents;
  std::vector<GoalRule> goals;  // of each group
  for (const AgentGroupConfig& group : config.groups) {
    if (auto error = group.check()) return tl::unexpected<Error>(std::move(*error));
    const auto area = area_of(group.parcel, farm);
    if (!area) return tl::unexpected<Error>(area.error());
    goals.push_back(goals_within(Region(*area)));
    const GoalRule& anywhere = goals.back();
    CrowdAgent agent;
    agent.group = static_cast<int>(goals.size()) - 1;
    agent.kind = group.kind;
    agent.behaviour = group.behaviour;
    agent.radius_m = group.radius_m;
    agent.speed_mps = group.speed_mps;
    agent.max_speed_mps = std::max(group.speed_mps, group.max_speed_mps);
    for (int i = 0; i < group.count; ++i) {
      const auto place = place_for(agent, anywhere, starts, config.apart_m, random);
      const auto goal = anywhere(agent, random);
      if (!place || !goal) return tl::unexpected<Error>(no_place(group));
      agent.position = *place;
      agent.goal = *goal;
      agents.push_back(agent);
    }
  }
  const GoalRule in_own_area = [goals](const CrowdAgent& agent, RandomStream& stream) {
    return goals[static_cast<std::size_t>(agent.group)](agent, stream);
  };
  return Crowd(config.crowd, std::move(agents), {}, seed, in_own_area);
}

ClearanceMap obstacles_of(const Farm& farm, double free_end) {
  std::vector<Polygon> rows;
  for (const RowParcel& parcel : farm.row_parcels) {
    for (const Row& row : parcel.rows) {
      const Polyline inner = shortened(shortened(row.line, free_end), free_end);
      if (inner.size() < 2) continue;
      for (Polygon& strip : widen(inner, parcel.row_spacing_m)) rows.push_back(std::move(strip));
    }
  }
  const MapBox all = extent(farm);
  const Point2 size = all.sizes();
  const double cell = std::max(kCell, std::sqrt(size.x() * size.y() / kMostCells));
  return ClearanceMap::around(subtract(drivable_area(farm), rows), cell);
}

}  // namespace headland
