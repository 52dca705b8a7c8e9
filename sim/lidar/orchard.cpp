// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/orchard.hpp"

#include "core/base/result.hpp"

namespace headland {

std::optional<Error> OrchardConfig::check() const {
  const auto wrong = [](const char* what, const char* remedy, const char* key) {
    return Error{ErrorCode::kOutOfRange, what, remedy, Location{{}, 0, key}};
  };
  if (canopy_low_m > canopy_high_m) {
    return wrong("canopy_low_m lies above canopy_high_m", "must not be above it", "canopy_low_m");
  }
  if (grass_low_m > grass_high_m) {
    return wrong("grass_low_m lies above grass_high_m", "must not be above it", "grass_low_m");
  }
  return std::nullopt;
}

OrchardConfig vineyard(bool in_leaf) {
  OrchardConfig config;
  if (!in_leaf) config.leaf_area_density_1pm = 0.0;
  return config;
}

OrchardConfig fruit_orchard(bool in_leaf) {
  OrchardConfig config;
  config.trunk_pitch_m = 1.25;
  config.trunk_radius_m = 0.05;
  config.trunk_height_m = 2.5;
  config.post_pitch_m = 10.0;
  config.post_radius_m = 0.05;
  config.post_height_m = 3.2;
  config.wire_heights_m = {0.8, 1.6, 2.4, 3.1};
  config.canopy_low_m = 0.6;
  config.canopy_high_m = 3.2;
  config.canopy_half_width_m = 0.7;
  config.leaf_area_density_1pm = in_leaf ? 1.8 : 0.0;
  config.branch_area_density_1pm = 0.3;
  config.crown_ratio = 0.6;
  return config;
}

}  // namespace headland
