// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/world/clearance_map.hpp"
#include "core/world/farm.hpp"
#include "sim/crowd/crowd.hpp"

namespace headland {

/// Some people or animals of a simulated mission.
struct AgentGroupConfig {
  AgentKind kind = AgentKind::kPerson;
  Behaviour behaviour = Behaviour::kOrca;
  int count = 1;
  std::string parcel;
  double radius_m = 0.3;
  double speed_mps = 1.2;
  double max_speed_mps = 1.5;

  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("kind", kind, "person, sheep, cattle, dog or vehicle");
    v("behaviour", behaviour,
      "orca: gives way; orca_blind: but not to vehicles; ignore: sees nobody; herd: an animal");
    v("count", count, config::Range{0, 10000}, "How many");
    v("parcel", parcel,
      "Id of the row or free parcel where they begin and people's goals lie, no fence for a herd; "
      "empty: anywhere drivable");
    v("radius_m", radius_m, config::Range{0.05, 5.0}, "Of the disc that holds one [m]");
    v("speed_mps", speed_mps, config::Range{0.0, 10.0},
      "They walk at this; a herd as its model says [m/s]");
    v("max_speed_mps", max_speed_mps, config::Range{0.0, 10.0}, "... and at most at this [m/s]");
  }
};

/// Who is about while a plan is driven.
struct FieldAgentsConfig {
  std::vector<AgentGroupConfig> groups;
  double apart_m = 6.0;
  double robot_share_ratio = 0.5;
  CrowdConfig crowd;

  bool anyone() const;

  template <class V>
  void visit(V& v) {
    v("groups", groups, "People and animals; none: nobody");
    v("apart_m", apart_m, config::kNonNegative, "Nobody begins nearer to a vehicle's start [m]");
    v("robot_share_ratio", robot_share_ratio, config::kFraction,
      "Of the avoidance that agents take on towards vehicles; 0: vehicles are invisible to them");
    v("crowd", crowd, "How agents avoid each other");
  }
};

/// The people and animals of a farm. They begin, and walk to goals, uniformly in their group's
/// parcel. A herd has no goals and no fence: it may leave its parcel. The same seed gives the same
/// agents.
/// @return kUnknownName for a parcel that the farm does not have; kOutOfRange if the farm or parcel
/// has no place for a group.
Result<Crowd> make_crowd(const FieldAgentsConfig& config, const Farm& farm,
                         std::span<const Point2> starts, std::uint64_t seed);

/// What the local planner keeps off on a farm: all that is not drivable, and the rows of its
/// parcels but for their last `free_end` [m] at both ends, where vehicles turn in.
ClearanceMap obstacles_of(const Farm& farm, double free_end = 3.0);

}  // namespace headland
