// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

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

  bool flat() const;     ///< no terrain
  bool uniform() const;  ///< flat, and the same soil everywhere
  /// Flat ground: height and gradient zero everywhere. Error kOffTerrain as Terrain::at.
  Result<TerrainSample> at(const Point2& p_map) const;
  std::optional<TerrainSample> sample(const Point2& p_map) const;
  /// Of the last soil area (in the farm's order) that holds the point; roads are track; else firm.
  SoilClass soil(const Point2& p_map) const;
  /// Null on flat ground.
  const Terrain* terrain() const;
  std::uint64_t fingerprint() const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// Opens the farm's terrain files, or makes its hills; flat if it has neither.
Result<Ground> load_ground(const Farm& farm);

/// Slope along the heading (pitch, positive uphill) and across it (roll, positive: left side up)
/// [rad].
struct Attitude {
  double pitch = 0.0;
  double roll = 0.0;
};
Attitude attitude(const TerrainSample& ground, double yaw);

/// What driving `path` as `kind` costs on that ground: energy by steps no longer than half a cell
/// of the terrain; `cusps` of the path included as standing time. On uniform ground closed form.
/// Error kOffTerrain names the first point off the terrain.
Result<DriveCost> path_cost(const Vehicle& vehicle, const Ground& ground, const Path& path,
                            LegKind kind);

/// Error kTooSteep names the first point where the path is steeper or more tilted than the vehicle
/// may drive; kOffTerrain.
std::optional<Error> check_slopes(const Vehicle& vehicle, const Ground& ground, const Path& path);

}  // namespace headland
