// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/base/result.hpp"
#include "core/geometry/pose2.hpp"
#include "core/world/geodesy.hpp"

namespace headland {

struct TerrainSample {
  double height = 0.0;        ///< [m]
  Point2 gradient{0.0, 0.0};  ///< of the height to map east and north [m/m]
};

/// Hills for tests and demonstrations.
struct HillSpec {
  std::uint64_t seed = 1;
  double relief_m = 20.0;       ///< highest less lowest point, which lies at 0
  double wavelength_m = 200.0;  ///< of the largest hills
  double cell_m = 2.0;          ///< spacing of grid points
};

/// A rectangle of the map [m].
using MapBox = Eigen::AlignedBox2d;

/// Heights on a grid: bilinear in between. Heights are those of the file's own grid; a point of the
/// map is taken to the grid by a polynomial fitted to the exact transformation (checked to a
/// thousandth of a cell). Immutable; queries are thread-safe and do not allocate unless they fail.
class Terrain {
 public:
  /// A grid given in the map frame: `heights` row by row from the south-west corner, NaN: no data.
  /// Grid points lie `cell` [m] apart, the first at `south_west`.
  static Terrain from_grid(Point2 south_west, double cell, int columns, int rows,
                           std::vector<double> heights);
  /// Seeded hills over a rectangle of the map: waves of all directions whose height goes with their
  /// length. Same seed, same bytes.
  static Terrain hills(const HillSpec& spec, Point2 south_west, Point2 north_east);

  /// Height and gradient at a point. Error kOffTerrain names the point where it lies outside the
  /// grid or beside a cell without data.
  Result<TerrainSample> at(const Point2& p_map) const;
  /// The same without the message: nullopt where at() fails.
  std::optional<TerrainSample> sample(const Point2& p_map) const;
  /// The height alone [m]; faster.
  std::optional<double> height(const Point2& p_map) const;
  double cell() const { return cell_; }  ///< spacing of grid points, the smaller one [m]
  /// Bytes that tell this terrain from others, for caches: a hash of its grid.
  std::uint64_t fingerprint() const;

 private:
  friend Result<Terrain> load_terrain(const std::filesystem::path& file, const LocalFrame& frame,
                                      const std::optional<MapBox>& extent);
  /// Grid column or row: a polynomial of third degree in u and v, the map's coordinates less
  /// center_ over scale_. Coefficients of 1, u, v, u2, uv, v2, u3, u2v, uv2, v3.
  using Cubic = std::array<double, 10>;

  // A point in the polynomial's coordinates, its height and the height's change per column and row.
  struct Place {
    double u = 0.0;
    double v = 0.0;
    double height = 0.0;
    double by_column = 0.0;
    double by_row = 0.0;
  };
  std::optional<Place> find(const Point2& p_map) const;

  int columns_ = 0;
  int rows_ = 0;
  double cell_ = 1.0;
  std::vector<float> heights_;  // by row; NaN: no data
  Point2 center_{0.0, 0.0};
  double scale_ = 1.0;
  Cubic to_column_{};
  Cubic to_row_{};
};

/// Reads a GeoTIFF of any coordinate system (GDAL): its first band, in metres or feet; only the
/// part around `extent`, if that is given. Errors: kFileNotFound; kSyntax (not a raster, no
/// coordinate system, no data at all); kOffTerrain (nothing of `extent` is on it); kUnsupported
/// (too large, or too wide for the polynomial).
Result<Terrain> load_terrain(const std::filesystem::path& file, const LocalFrame& frame,
                             const std::optional<MapBox>& extent = std::nullopt);

}  // namespace headland
