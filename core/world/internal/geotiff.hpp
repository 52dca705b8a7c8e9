// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/base/result.hpp"
#include "core/world/terrain.hpp"

namespace headland::internal {

/// A part of a raster, and where some of its points lie.
struct Raster {
  /// A place in the grid, in columns and rows of this part, and the same place on the map.
  struct Tie {
    Point2 in_grid;
    Point2 p_map;
  };
  int columns = 0;             ///< >= 2
  int rows = 0;                ///< >= 2
  std::vector<float> heights;  ///< [m] at the centres of the pixels, by row; NaN: no data
  std::vector<Tie> ties;       ///< exact; a net over the whole part
};

/// Reads the part of a GeoTIFF around `extent`, or all of it; errors as load_terrain.
Result<Raster> read_geotiff(const std::filesystem::path& file, const LocalFrame& frame,
                            const std::optional<MapBox>& extent);

}  // namespace headland::internal
