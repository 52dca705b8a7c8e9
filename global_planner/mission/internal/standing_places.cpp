// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/internal/standing_places.hpp"

#include <string>

#include <fmt/format.h>

#include "core/geometry/region.hpp"
#include "global_planner/coverage/transitions.hpp"

namespace headland::mission {
namespace {

constexpr double kSpacing = 0.25;  // of the outlines along a row [m]

struct Place {
  std::string name;
  Pose2 pose;
  std::string key;
};

std::vector<Place> places_of(const Mission& mission, std::size_t v) {
  const MissionVehicle& vehicle = mission.vehicles[v];
  std::vector<Place> places{{"the start", vehicle.start, fmt::format("vehicles.{}.start", v)},
                            {"the finish", vehicle.finish, fmt::format("vehicles.{}.finish", v)}};
  for (const Charger& c : mission.farm.chargers) places.push_back({"charger " + c.id, c.pose, ""});
  for (const Visit& visit : mission.visits) {
    const Poi& poi = mission.farm.pois[static_cast<std::size_t>(visit.poi)];
    places.push_back({"poi " + poi.id, poi.pose, ""});
  }
  return places;
}

std::optional<Error> off_terrain(const Mission& mission, const std::string& what,
                                 const Point2& at) {
  const auto ground = mission.ground.at(at);
  if (ground) return std::nullopt;
  Error error = ground.error();
  error.what = what + ": " + error.what;
  return error;
}

std::optional<Error> check_place(const Mission& mission, const Region& drivable,
                                 const MissionVehicle& vehicle, const Place& place) {
  if (auto error = off_terrain(mission, place.name, place.pose.position())) return error;
  if (drivable.contains(place.pose, vehicle.vehicle.footprint)) return std::nullopt;
  return Error{ErrorCode::kNoPath,
               fmt::format("{} at ({:.1f}, {:.1f}): the vehicle {} does not fit into the drivable "
                           "area there",
                           place.name, place.pose.x, place.pose.y, vehicle.id),
               "put it on a road, headland or free parcel, clear of keep-outs",
               {{}, 0, place.key}};
}

std::optional<Error> check_row(const Mission& mission, const Region& drivable,
                               const MissionVehicle& vehicle, RowRef ref) {
  const std::string name = "row " + mission.farm.row_name(ref);
  const Path path = row_path(mission.farm.row(ref), 0, vehicle.vehicle.turning_radius());
  const Footprint& outline = vehicle.vehicle.footprint;
  for (const PathSample& sample : path.sample(kSpacing)) {
    if (auto error = off_terrain(mission, name, sample.pose.position())) return error;
    // Either way round: the row may be driven in both directions.
    if (drivable.contains(sample.pose, outline)) continue;
    if (drivable.contains(reversed(sample.pose), outline)) continue;
    return Error{ErrorCode::kNoPath,
                 fmt::format("{} at ({:.1f}, {:.1f}): the vehicle's outline leaves the drivable "
                             "area or enters a keep-out",
                             name, sample.pose.x, sample.pose.y),
                 "leave the row out (tasks.rows), or correct keep-out, parcel or row",
                 {}};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Error> check_standing_places(const Mission& mission) {
  const Region drivable(drivable_area(mission.farm));
  for (std::size_t v = 0; v < mission.vehicles.size(); ++v) {
    const MissionVehicle& vehicle = mission.vehicles[v];
    for (const Place& place : places_of(mission, v)) {
      if (auto error = check_place(mission, drivable, vehicle, place)) return error;
    }
    for (const RowRef ref : mission.rows) {
      if (auto error = check_row(mission, drivable, vehicle, ref)) return error;
    }
  }
  return std::nullopt;
}

}  // namespace headland::mission
