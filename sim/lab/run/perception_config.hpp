// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

#include "core/config/visit.hpp"
#include "perception/cloud/cloud.hpp"
#include "perception/localization/localizer.hpp"
#include "perception/rows/row_detector.hpp"
#include "sim/lidar/inertial.hpp"
#include "sim/lidar/lidar.hpp"
#include "sim/lidar/orchard.hpp"

namespace headland {

/// What grows along the rows.
enum class Crop : std::int8_t { kOrchardBare, kOrchardLeaf, kVineyardBare, kVineyardLeaf };

OrchardConfig plants_of(Crop crop);

/// What vehicles with a lidar see with it, and what they do with that. The scans are a quarter as
/// dense as the sensor's own, and every second one is looked at, which costs a tenth of the time.
struct PerceptionConfig {
  bool enabled = true;
  Crop crop = Crop::kOrchardLeaf;
  double period_s = 0.2;
  LidarConfig lidar{.azimuth_step_deg = 0.4, .sub_rays_count = 2};
  InertialConfig inertial;
  CropConfig view{.far_m = 25.0, .high_m = 4.0};
  RowDetectorConfig rows;
  LocalizerConfig localizer;

  template <class V>
  void visit(V& v) {
    v("enabled", enabled,
      "Vehicles with a lidar drive rows by what it sees, not by the map, and know their poses by "
      "it and their other sensors");
    v("crop", crop, "What grows: orchard_bare, orchard_leaf, vineyard_bare, vineyard_leaf");
    v("period_s", period_s, config::Range{0.1, 5.0}, "Between scans that are looked at [s]");
    v("lidar", lidar, "The lidar");
    v("inertial", inertial, "The inertial unit beside it");
    v("view", view, "Which points are looked at for rows");
    v("rows", rows, "How rows are found; row_width_m is the parcel's, sensor_* are the mount's");
    v("localizer", localizer,
      "How poses are found; wheelbase_m is the vehicle's, odometry.lidar and odometry.imu are the "
      "mount's");
  }
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::Crop> {
  static constexpr std::pair<headland::Crop, std::string_view> values[] = {
      {headland::Crop::kOrchardBare, "orchard_bare"},
      {headland::Crop::kOrchardLeaf, "orchard_leaf"},
      {headland::Crop::kVineyardBare, "vineyard_bare"},
      {headland::Crop::kVineyardLeaf, "vineyard_leaf"}};
};
