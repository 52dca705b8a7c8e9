// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/model/drive_cost.hpp"
#include "core/model/vehicle.hpp"
#include "core/world/farm.hpp"

namespace headland {

/// A place named in a mission: a POI or charger of the farm, or a pose in the farm's map frame.
struct PlaceConfig {
  std::string poi;
  std::optional<double> x_m;
  std::optional<double> y_m;
  double heading_deg = 0.0;

  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("poi", poi, "Id of a poi or charger of the farm");
    v("x_m", x_m, "East of the farm's origin [m]");
    v("y_m", y_m, "North of the farm's origin [m]");
    v("heading_deg", heading_deg, config::Range{-360.0, 360.0},
      "Heading for x_m, y_m, counter-clockwise from east [deg]");
  }
};

struct MissionVehicleConfig {
  std::string id;
  std::string model;
  double soc = 1.0;
  PlaceConfig start;
  std::optional<PlaceConfig> finish;
  std::optional<double> capacity_wh;

  template <class V>
  void visit(V& v) {
    v.required("id", id, "Name of this vehicle in the plan");
    v.required("model", model, "Vehicle file, relative to the mission's file");
    v("soc", soc, config::kFraction, "State of charge at the start");
    v.required("start", start, "Where it starts");
    v("finish", finish, "Where it ends; default: where it starts");
    v("capacity_wh", capacity_wh, config::Range{1.0, 1e7},
      "Replaces the model's battery capacity [Wh]");
  }
};

/// Cover rows: of all parcels, of some, or some rows by name.
struct TaskConfig {
  std::vector<std::string> cover{"all"};
  std::vector<std::string> rows;

  template <class V>
  void visit(V& v) {
    v("cover", cover, "Parcel ids, or all");
    v("rows", rows, "Only these rows of them, as parcel/row; empty: all");
  }
};

struct PlannerConfig {
  std::uint64_t seed = 1;
  int iterations = 0;
  int exact_up_to_rows = 16;
  double margin_m = 0.1;
  double energy_margin_ratio = 0.05;
  bool fishtail = true;
  bool reeds_shepp = true;

  template <class V>
  void visit(V& v) {
    v("seed", seed, config::kNonNegative, "Seed of the search");
    v("iterations", iterations, config::kNonNegative,
      "Local-search kicks; 0: a number that suits the size");
    v("exact_up_to_rows", exact_up_to_rows, config::Range{0, 18},
      "Up to this many rows the order is proven optimal");
    v("margin_m", margin_m, config::Range{0.0, 10.0},
      "Kept between the outline and the edge of the drivable area [m]");
    v("energy_margin_ratio", energy_margin_ratio, config::Range{0.0, 1.0},
      "Recharge stops are planned as if all driving drew this much more: ramps, slowing, noise");
    v("fishtail", fishtail, "Allow fishtail turns");
    v("reeds_shepp", reeds_shepp, "Allow Reeds-Shepp turns");
  }
};

/// A mission file: a farm, vehicles, tasks, an objective.
struct MissionConfig {
  std::string name;
  std::vector<std::string> farm;
  double headland_outside_m = 0.0;
  std::vector<MissionVehicleConfig> vehicles;
  std::vector<TaskConfig> tasks{TaskConfig{}};
  Objective objective = Objective::kEnergy;
  PlannerConfig planner;

  template <class V>
  void visit(V& v) {
    v.required("name", name, "Title of plan and report");
    v.required("farm", farm, "Farm files, relative to the mission's file; later ones add features");
    v("headland_outside_m", headland_outside_m, config::Range{0.0, 1000.0},
      "Drivable strip around row parcels whose file gives none [m]");
    v.required("vehicles", vehicles, "The fleet");
    v("tasks", tasks, "What to do");
    v("objective", objective, "energy, time or length");
    v("planner", planner, "Search settings");
  }
};

/// A vehicle of the mission with everything looked up.
struct MissionVehicle {
  std::string id;
  Vehicle vehicle;
  double soc = 1.0;
  Pose2 start;
  Pose2 finish;
};

/// A mission ready to be planned.
struct Mission {
  MissionConfig config;
  Farm farm;
  std::vector<MissionVehicle> vehicles;
  std::vector<RowRef> rows;  ///< to be driven
};

/// Loads the farm and vehicles that a mission's configuration names. Paths are relative to
/// `directory`; `$HEADLAND_DATA` in them is replaced by that variable, or by `../shared/data` where
/// it is not set. Errors: of the files, unknown names (kUnknownName), no rows to cover (kNoRows).
Result<Mission> load_mission(const MissionConfig& config, const std::filesystem::path& directory);

/// `path` with $HEADLAND_DATA replaced, relative to `directory`.
std::filesystem::path resolve_path(const std::string& path, const std::filesystem::path& directory);

}  // namespace headland
