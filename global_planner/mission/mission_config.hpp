// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "core/model/drive_cost.hpp"
#include "core/model/vehicle.hpp"
#include "core/world/farm.hpp"
#include "core/world/ground.hpp"

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
  std::optional<double> payload_kg;
  std::optional<double> shift_s;
  std::optional<SensorMount> lidar;

  template <class V>
  void visit(V& v) {
    v.required("id", id, "Name of this vehicle in the plan");
    v.required("model", model, "Vehicle file, relative to the mission's file");
    v("soc", soc, config::kFraction, "State of charge at the start");
    v.required("start", start, "Where it starts");
    v("finish", finish, "Where it ends; default: where it starts");
    v("capacity_wh", capacity_wh, config::Range{1.0, 1e7},
      "Replaces the model's battery capacity [Wh]");
    v("payload_kg", payload_kg, config::Range{0.0, 1e5}, "Replaces the model's payload [kg]");
    v("shift_s", shift_s, config::Range{1.0, 1e7}, "It is back at its finish by then [s]");
    v("lidar", lidar, "A lidar is fitted here, in place of the model's");
  }
};

/// Rows to cover (of all parcels, of some, or some rows by name) or places to visit.
struct TaskConfig {
  std::vector<std::string> cover;
  std::vector<std::string> rows;
  std::vector<std::string> places;
  double accuracy_m = 1.0;
  double dwell_s = 0.0;
  double value_ratio = 1.0;
  double earliest_s = 0.0;
  std::optional<double> latest_s;

  std::optional<Error> check() const;

  template <class V>
  void visit(V& v) {
    v("cover", cover, "Parcel ids, or all");
    v("rows", rows, "Only these rows of them, as parcel/row; empty: all");
    v("visit", places, "Ids or roles of pois; all: every poi");
    v("accuracy_m", accuracy_m, config::Range{0.01, 100.0},
      "A visit counts from this near: observation 5, soil sampling 2, weed spraying 1 (seed 003) "
      "[m]");
    v("dwell_s", dwell_s, config::Range{0.0, 1e5}, "Standing time of a visit [s]");
    v("value_ratio", value_ratio, config::Range{0.01, 100.0},
      "Of each row or visit, beside the others', when some have to be dropped");
    v("earliest_s", earliest_s, config::Range{0.0, 1e7}, "Not begun before [s]");
    v("latest_s", latest_s, config::Range{0.0, 1e7}, "Begun by then [s]");
  }
};

struct PlannerConfig {
  std::uint64_t seed = 1;
  int iterations = 0;
  int exact_up_to_tasks = 15;
  int roadmap_samples = 1000;
  std::string cache;
  double margin_m = 0.1;
  double energy_margin_ratio = 0.05;
  double time_margin_ratio = 0.05;
  bool fishtail = true;
  bool reeds_shepp = true;

  template <class V>
  void visit(V& v) {
    v("seed", seed, config::kNonNegative, "Seed of the search");
    v("iterations", iterations, config::kNonNegative,
      "Rounds of the search; 0: a number that suits the size");
    v("exact_up_to_tasks", exact_up_to_tasks, config::Range{0, 18},
      "Up to this many rows and visits the plan is sought exactly");
    v("roadmap_samples", roadmap_samples, config::Range{0, 1000000},
      "Poses of the roadmap over free parcels; 0: no roadmap");
    v("cache", cache, "Folder in which roadmaps are kept; empty: none");
    v("margin_m", margin_m, config::Range{0.0, 10.0},
      "Kept between the outline and the edge of the drivable area [m]");
    v("energy_margin_ratio", energy_margin_ratio, config::Range{0.0, 1.0},
      "Recharge stops are planned as if all driving drew this much more: ramps, slowing, noise");
    v("time_margin_ratio", time_margin_ratio, config::Range{0.0, 1.0},
      "Shifts and latest times are planned as if all took this much longer: slowing down, braking");
    v("fishtail", fishtail, "Allow fishtail turns");
    v("reeds_shepp", reeds_shepp, "Allow Reeds-Shepp turns");
  }
};

/// Weights of energy, time and length, so that the sum is in joules.
struct WeightsConfig {
  double energy_ratio = 1.0;
  double time_w = 0.0;
  double length_n = 0.0;

  template <class V>
  void visit(V& v) {
    v("energy_ratio", energy_ratio, config::kNonNegative, "Of a joule");
    v("time_w", time_w, config::kNonNegative, "Of a second, in joules [W]");
    v("length_n", length_n, config::kNonNegative, "Of a metre, in joules [N]");
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
  WeightsConfig weights;
  bool allow_dropping = false;
  PlannerConfig planner;

  std::optional<Error> check() const;

  /// What is minimised.
  CostWeights cost_weights() const {
    if (objective != Objective::kWeighted) return objective;
    return {weights.energy_ratio, weights.time_w, weights.length_n};
  }

  template <class V>
  void visit(V& v) {
    v.required("name", name, "Title of plan and report");
    v.required("farm", farm, "Farm files, relative to the mission's file; later ones add features");
    v("headland_outside_m", headland_outside_m, config::Range{0.0, 1000.0},
      "Drivable strip around row parcels whose file gives none [m]");
    v.required("vehicles", vehicles, "The fleet");
    v("tasks", tasks, "What to do");
    v("objective", objective,
      "energy, time (until the last vehicle is done), length, or weighted (see weights)");
    v("weights", weights, "Of the objective `weighted`");
    v("allow_dropping", allow_dropping,
      "Leave out the least valuable tasks where energy or time is too short for all");
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
  double shift_s = std::numeric_limits<double>::infinity();
};

/// What a task is worth, and when it may be begun.
struct TaskTerms {
  double value = 1.0;
  double earliest_s = 0.0;
  double latest_s = std::numeric_limits<double>::infinity();
};

/// A poi to be visited.
struct Visit {
  int poi = 0;  ///< in Farm::pois
  double accuracy_m = 1.0;
  double dwell_s = 0.0;
  TaskTerms terms;
};

/// A mission ready to be planned.
struct Mission {
  MissionConfig config;
  Farm farm;
  Ground ground;
  std::vector<MissionVehicle> vehicles;
  std::vector<RowRef> rows;          ///< to be driven
  std::vector<TaskTerms> row_terms;  ///< of each of them
  std::vector<Visit> visits;
};

/// Loads the farm and vehicles that a mission's configuration names. Paths are relative to
/// `directory`; `$HEADLAND_DATA` in them is replaced by that variable, or by `../shared/data` where
/// it is not set. Errors: of the files, unknown names (kUnknownName), no rows to cover (kNoRows).
Result<Mission> load_mission(const MissionConfig& config, const std::filesystem::path& directory);

/// `path` with $HEADLAND_DATA replaced, relative to `directory`.
std::filesystem::path resolve_path(const std::string& path, const std::filesystem::path& directory);

}  // namespace headland
