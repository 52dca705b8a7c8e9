// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/mission_config.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "core/config/yaml.hpp"
#include "core/world/farm_io.hpp"

namespace headland {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

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

bool covers_rows(const TaskConfig& task) { return task.places.empty(); }

bool wants(const TaskConfig& task, const Farm& farm, RowRef ref) {
  if (!covers_rows(task)) return false;
  const std::string& parcel = farm.row_parcels[static_cast<std::size_t>(ref.parcel)].id;
  const bool everywhere = task.cover.empty() || names(task.cover, "all");
  if (!everywhere && !names(task.cover, parcel)) return false;
  return task.rows.empty() || names(task.rows, farm.row_name(ref));
}

bool wants(const TaskConfig& task, const Poi& poi) {
  return names(task.places, "all") || names(task.places, poi.id) || names(task.places, poi.role);
}

template <class List, class Name>
std::string listed(const List& list, Name name, std::string text) {
  for (const auto& item : list) text += (text.empty() ? "" : ", ") + name(item);
  return text;
}

std::optional<Error> check_task_names(const TaskConfig& task, const Farm& farm,
                                      const std::string& key) {
  for (const std::string& id : task.cover) {
    if (id == "all" || farm.find_parcel(id) != nullptr) continue;
    return Error{ErrorCode::kUnknownName,
                 "no row parcel '" + id + "' in the farm",
                 "allowed: " + listed(
                                   farm.row_parcels, [](const auto& p) { return p.id; }, "all"),
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
  for (const std::string& id : task.places) {
    const bool found = std::any_of(farm.pois.begin(), farm.pois.end(), [&](const Poi& poi) {
      return id == "all" || id == poi.id || id == poi.role;
    });
    if (found) continue;
    return Error{ErrorCode::kUnknownName,
                 "no poi of the id or role '" + id + "' in the farm",
                 "allowed: " + listed(
                                   farm.pois, [](const Poi& p) { return p.id; }, "all"),
                 {{}, 0, key + ".visit"}};
  }
  return std::nullopt;
}

TaskTerms terms_of(const TaskConfig& task) {
  TaskTerms terms{task.value_ratio, task.earliest_s, kForever};
  if (task.latest_s) terms.latest_s = *task.latest_s;
  return terms;
}

// Rows and places that the tasks name; each once, by the first task that does.
Result<void> look_up_tasks(Mission& mission) {
  const std::vector<TaskConfig>& tasks = mission.config.tasks;
  const Farm& farm = mission.farm;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (auto error = check_task_names(tasks[i], farm, fmt::format("tasks.{}", i))) {
      return tl::unexpected<Error>(std::move(*error));
    }
  }
  const auto first = [&](auto wanted) {
    const auto at = std::find_if(tasks.begin(), tasks.end(), wanted);
    return at == tasks.end() ? nullptr : &*at;
  };
  for (const RowRef ref : farm.all_rows()) {
    const TaskConfig* task = first([&](const TaskConfig& t) { return wants(t, farm, ref); });
    if (task == nullptr) continue;
    mission.rows.push_back(ref);
    mission.row_terms.push_back(terms_of(*task));
  }
  for (int p = 0; p < static_cast<int>(farm.pois.size()); ++p) {
    const Poi& poi = farm.pois[static_cast<std::size_t>(p)];
    const TaskConfig* task = first([&](const TaskConfig& t) { return wants(t, poi); });
    if (task == nullptr) continue;
    mission.visits.push_back({p, task->accuracy_m, task->dwell_s, terms_of(*task)});
  }
  if (mission.rows.empty() && mission.visits.empty()) {
    return fail(ErrorCode::kNoRows, "the tasks cover no row of the farm and visit no place",
                "name parcels that have rows, or cover: all", {{}, 0, "tasks"});
  }
  return {};
}

Result<MissionVehicle> load_vehicle(const MissionVehicleConfig& config, const Farm& farm,
                                    const std::filesystem::path& directory,
                                    const std::string& key) {
  auto vehicle = config::load<Vehicle>(resolve_path(config.model, directory));
  if (!vehicle) return tl::unexpected<Error>(vehicle.error());
  if (config.capacity_wh) vehicle->battery.capacity_wh = *config.capacity_wh;
  if (config.lidar) vehicle->lidar = config.lidar;
  if (config.payload_kg) vehicle->energy.payload_kg = *config.payload_kg;
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
  return MissionVehicle{config.id,  std::move(*vehicle),
                        config.soc, *start,
                        *finish,    config.shift_s.value_or(kForever)};
}

}  // namespace

std::optional<Error> PlaceConfig::check() const {
  const bool named = !poi.empty();
  const bool placed = x_m.has_value() && y_m.has_value();
  if (named != placed && x_m.has_value() == y_m.has_value()) return std::nullopt;
  return Error{
      ErrorCode::kMissingKey, "a place is needed", "give either poi, or both x_m and y_m", {}};
}

std::optional<Error> TaskConfig::check() const {
  const bool rows_too = !cover.empty() || !rows.empty();
  if (!places.empty() && rows_too) {
    return Error{ErrorCode::kOutOfRange,
                 "a task covers rows or visits places",
                 "write two tasks",
                 {{}, 0, "visit"}};
  }
  if (!latest_s || *latest_s >= earliest_s) return std::nullopt;
  return Error{ErrorCode::kOutOfRange,
               "latest_s lies before earliest_s",
               "write a later time",
               {{}, 0, "latest_s"}};
}

std::optional<Error> MissionConfig::check() const {
  const bool weighted = objective == Objective::kWeighted;
  const bool given =
      weights.energy_ratio != 1.0 || weights.time_w != 0.0 || weights.length_n != 0.0;
  if (!weighted && given) {
    return Error{ErrorCode::kOutOfRange,
                 "weights are given, but the objective does not use them",
                 "write objective: weighted",
                 {{}, 0, "weights"}};
  }
  if (!weighted || weights.energy_ratio + weights.time_w + weights.length_n > 0.0) {
    return std::nullopt;
  }
  return Error{ErrorCode::kOutOfRange,
               "all weights are zero",
               "one of them must be positive",
               {{}, 0, "weights"}};
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

  auto ground = load_ground(mission.farm);
  if (!ground) return tl::unexpected<Error>(ground.error());
  mission.ground = std::move(*ground);

  if (config.vehicles.empty()) {
    return fail(ErrorCode::kMissingKey, "a mission needs a vehicle", "list at least one",
                {{}, 0, "vehicles"});
  }
  for (std::size_t i = 0; i < config.vehicles.size(); ++i) {
    auto vehicle =
        load_vehicle(config.vehicles[i], mission.farm, directory, fmt::format("vehicles.{}", i));
    if (!vehicle) return tl::unexpected<Error>(vehicle.error());
    for (const MissionVehicle& other : mission.vehicles) {
      if (other.id != vehicle->id) continue;
      return fail(ErrorCode::kUnknownName, "two vehicles are called '" + other.id + "'",
                  "give each its own id", {{}, 0, fmt::format("vehicles.{}.id", i)});
    }
    mission.vehicles.push_back(std::move(*vehicle));
  }
  if (auto found = look_up_tasks(mission); !found) return tl::unexpected<Error>(found.error());
  return mission;
}

}  // namespace headland
