// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"

namespace headland {

enum class AgentKind : std::int8_t { kPerson, kSheep, kCattle, kDog, kVehicle };

/// Someone who moves on the farm, as seen at one moment: a person, an animal, another vehicle.
struct Agent {
  int id = 0;  ///< the same from sight to sight
  AgentKind kind = AgentKind::kPerson;
  Point2 position{0.0, 0.0};  ///< centre, in `map` [m]
  Point2 velocity{0.0, 0.0};  ///< [m/s]; zero if it is not observed
  double radius_m = 0.3;      ///< of the disc that holds it
  double noise_m = 0.0;       ///< standard deviation of the position, per axis [m]
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::AgentKind> {
  static constexpr std::pair<headland::AgentKind, std::string_view> values[] = {
      {headland::AgentKind::kPerson, "person"},
      {headland::AgentKind::kSheep, "sheep"},
      {headland::AgentKind::kCattle, "cattle"},
      {headland::AgentKind::kDog, "dog"},
      {headland::AgentKind::kVehicle, "vehicle"}};
};
