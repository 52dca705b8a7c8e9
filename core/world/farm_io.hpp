// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.hpp"
#include "core/world/farm.hpp"

namespace headland {

/// Values for features whose file does not say.
struct FarmDefaults {
  double headland_outside_m = 0.0;  ///< for row parcels
};

/// Loads one farm from GeoJSON files (WGS84; DESIGN section 6), later files adding to the earlier.
/// Files in the AGRIDS vineyard schema (properties.class: block, row, building, entrance_exit, ...)
/// are recognised and turned into ours. The origin is the first file's `headland.origin`
/// [lon, lat], or else the centre of its bounding box.
/// Checked: JSON and GeoJSON form, unknown kinds and keys, self-crossing or empty polygons,
/// rows outside their parcel, spacing > 0, duplicate ids, at least one feature.
/// Errors carry file, line (where the feature begins) and key, such as
/// features.3.properties.row_spacing_m.
Result<Farm> load_farm(const std::vector<std::filesystem::path>& files,
                       const FarmDefaults& defaults = {});

/// The rows that fill a parcel: parallel lines at its spacing and heading, centred across the
/// parcel, each cut `headland_width_m` (measured along the row) before the boundary. Error kNoRows
/// where none fits.
Result<std::vector<Row>> generate_rows(const RowParcel& parcel);

/// The farm as GeoJSON text in our own schema; load_farm reads it back.
std::string to_geojson(const Farm& farm);

}  // namespace headland
