// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/path.hpp"
#include "core/model/drive_cost.hpp"
#include "core/model/soil.hpp"
#include "core/model/vehicle.hpp"
#include "core/world/farm.hpp"
#include "core/world/terrain.hpp"

namespace headland {

/// What a vehicle drives on: heights and soil of a farm. Flat where the farm has no terrain.
/// Copies share their data. Thread-safe.
class Ground {
 public:
  Ground();  ///< flat and firm everywhere
  Ground(const Farm& farm, std::optional<Terrain> terrain);
  /// Where terrains overlap, the first that has a height counts.
  Ground(const Farm& farm, std::vector<Terrain> terrains);

  bool flat() const;     ///< no terrain
  bool uniform() const;  ///< flat, and the same soil everywhere
  /// Flat ground: height and gradient zero everywhere. Error kOffTerrain as Terrain::at.
  Result<TerrainSample> at(const Point2& p_map) const;
  std::optional<TerrainSample> sample(const Point2& p_map) const;
  std::optional<double> height(const Point2& p_map) const;  ///< alone [m]; faster
  /// Of the last soil area (in the farm's order) that holds the point; roads are track; else firm.
  SoilClass soil(const Point2& p_map) const;
  /// The first; null on flat ground.
  const Terrain* terrain() const;
  /// Distance [m] at which heights and soils are worth looking up along a path: half a cell of the
  /// terrain, at most 1 m where there are several soils, infinite on uniform ground.
  double step() const;
  /// Bytes that tell this ground from others, for caches.
  std::uint64_t fingerprint() const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// Opens the farm's terrain files, or makes its hills; flat if it has neither. Terrain is kept as
/// far as 60 m around the farm. Errors as load_terrain; kOffTerrain only if no file covers a part.
Result<Ground> load_ground(const Farm& farm);

/// Slope along the heading (pitch, positive uphill) and across it (roll, positive: left side up)
/// [rad], each against the horizontal.
struct Attitude {
  double pitch = 0.0;
  double roll = 0.0;
};
Attitude attitude(const TerrainSample& ground, double yaw);

/// What driving `path` as `kind` costs on that ground, in steps no longer than Ground::step();
/// closed form on uniform ground. Changes of gear are standing time. Heights are
/// taken at the ends of steps, so that the potential energy depends on the path's ends alone. Error
/// kOffTerrain names the first point off the terrain. About 50 ns a step.
Result<DriveCost> path_cost(const Vehicle& vehicle, const Ground& ground, const Path& path,
                            LegKind kind);

/// Error kTooSteep names the first point where the path is steeper or more tilted than the vehicle
/// may drive; kOffTerrain.
std::optional<Error> check_slopes(const Vehicle& vehicle, const Ground& ground, const Path& path);

}  // namespace headland
