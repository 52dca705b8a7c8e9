// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/mission_config.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "core/config/yaml.hpp"
#include "core/world/farm_io.hpp"

namespace headland {
namespace {

std::string known_places(const Farm& farm) {
  std::string names;
  for (const Poi& poi : farm.pois) names += (names.empty() ? "" : ", ") + poi.id;
  for (const Charger& charger : farm.chargers) names += (names.empty() ? "" : ", ") + charger.id;
  return names.empty() ? "the farm has none; give x_m and y_m" : "the farm has: " + names;
}

Result<Pose2> find_place(const Farm& farm, const PlaceConfig& place, const std::string& key) {
  if (place.poi.empty()) return Pose2{*place.x_m, *place.y_m, deg_to_rad(place.heading_deg)};
  if (const Poi* poi = farm.find_poi(place.poi)) return poi->pose;
  if (const Charger* charger = farm.find_charger(place.poi)) return charger->pose;
  return fail(ErrorCode::kUnknownName, "no poi or charger '" + place.poi + "' in the farm",
              known_places(farm), {{}, 0, key + ".poi"});
}

bool names(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

bool wants(const TaskConfig& task, const Farm& farm, RowRef ref) {
  const std::string& parcel = farm.row_parcels[static_cast<std::size_t>(ref.parcel)].id;
  if (!names(task.cover, "all") && !names(task.cover, parcel)) return false;
  return task.rows.empty() || names(task.rows, farm.row_name(ref));
}

std::optional<Error> check_task_names(const TaskConfig& task, const Farm& farm,
                                      const std::string& key) {
  for (const std::string& id : task.cover) {
    if (id == "all" || farm.find_parcel(id) != nullptr) continue;
    std::string known = "all";
    for (const RowParcel& parcel : farm.row_parcels) known += ", " + parcel.id;
    return Error{ErrorCode::kUnknownName,
                 "no row parcel '" + id + "' in the farm",
                 "allowed: " + known,
                 {{}, 0, key + ".cover"}};
  }
  std::vector<std::string> known;
  for (const RowRef ref : farm.all_rows()) known.push_back(farm.row_name(ref));
  for (const std::string& id : task.rows) {
    if (names(known, id)) continue;
    return Error{ErrorCode::kUnknownName,
                 "no row '" + id + "' in the farm",
                 known.empty() ? "the farm has no rows" : "rows are named like " + known.front(),
                 {{}, 0, key + ".rows"}};
  }
  return std::nullopt;
}

Result<std::vector<RowRef>> rows_to_cover(const MissionConfig& config, const Farm& farm) {
  for (std::size_t i = 0; i < config.tasks.size(); ++i) {
    if (auto error = check_task_names(config.tasks[i], farm, fmt::format("tasks.{}", i))) {
      return tl::unexpected<Error>(std::move(*error));
    }
  }
  std::vector<RowRef> rows;
  for (const RowRef ref : farm.all_rows()) {
    const bool wanted = std::any_of(config.tasks.begin(), config.tasks.end(),
                                    [&](const TaskConfig& task) { return wants(task, farm, ref); });
    if (wanted) rows.push_back(ref);
  }
  if (rows.empty()) {
    return fail(ErrorCode::kNoRows, "the tasks cover no row of the farm",
                "name parcels that have rows, or cover: all", {{}, 0, "tasks"});
  }
  return rows;
}

Result<MissionVehicle> load_vehicle(const MissionVehicleConfig& config, const Farm& farm,
                                    const std::filesystem::path& directory,
                                    const std::string& key) {
  auto vehicle = config::load<Vehicle>(resolve_path(config.model, directory));
  if (!vehicle) return tl::unexpected<Error>(vehicle.error());
  if (config.capacity_wh) vehicle->battery.capacity_wh = *config.capacity_wh;
  const double reserve = vehicle->battery.reserve_soc;
  if (config.soc < reserve) {
    return fail(ErrorCode::kOutOfRange,
                fmt::format("{} is below the battery's reserve of {}", config.soc, reserve),
                "start with more charge, or lower reserve_soc in " + config.model,
                {{}, 0, key + ".soc"});
  }
  const auto start = find_place(farm, config.start, key + ".start");
  if (!start) return tl::unexpected<Error>(start.error());
  const auto finish =
      config.finish ? find_place(farm, *config.finish, key + ".finish") : Result<Pose2>(*start);
  if (!finish) return tl::unexpected<Error>(finish.error());
  return MissionVehicle{config.id, std::move(*vehicle), config.soc, *start, *finish};
}

}  // namespace

std::optional<Error> PlaceConfig::check() const {
  const bool named = !poi.empty();
  const bool placed = x_m.has_value() && y_m.has_value();
  if (named != placed && x_m.has_value() == y_m.has_value()) return std::nullopt;
  return Error{
      ErrorCode::kMissingKey, "a place is needed", "give either poi, or both x_m and y_m", {}};
}

std::filesystem::path resolve_path(const std::string& path,
                                   const std::filesystem::path& directory) {
  static constexpr std::string_view kVariable = "$HEADLAND_DATA";
  if (path.rfind(kVariable, 0) != 0) return (directory / path).lexically_normal();
  const char* data = std::getenv("HEADLAND_DATA");
  return std::filesystem::path((data != nullptr && *data != '\0' ? data : "../shared/data") +
                               path.substr(kVariable.size()));
}

Result<Mission> load_mission(const MissionConfig& config, const std::filesystem::path& directory) {
  Mission mission;
  mission.config = config;
  std::vector<std::filesystem::path> files;
  for (const std::string& file : config.farm) files.push_back(resolve_path(file, directory));
  auto farm = load_farm(files, FarmDefaults{config.headland_outside_m});
  if (!farm) return tl::unexpected<Error>(farm.error());
  mission.farm = std::move(*farm);

  if (config.vehicles.size() != 1) {
    return fail(ErrorCode::kUnsupported, fmt::format("{} vehicles", config.vehicles.size()),
                "this version plans for exactly one", {{}, 0, "vehicles"});
  }
  for (std::size_t i = 0; i < config.vehicles.size(); ++i) {
    auto vehicle =
        load_vehicle(config.vehicles[i], mission.farm, directory, fmt::format("vehicles.{}", i));
    if (!vehicle) return tl::unexpected<Error>(vehicle.error());
    mission.vehicles.push_back(std::move(*vehicle));
  }
  auto rows = rows_to_cover(config, mission.farm);
  if (!rows) return tl::unexpected<Error>(rows.error());
  mission.rows = std::move(*rows);
  return mission;
}

}  // namespace headland
