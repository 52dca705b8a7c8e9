// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/polygon.hpp"
#include "core/model/charge_curve.hpp"
#include "core/model/soil.hpp"
#include "core/world/geodesy.hpp"
#include "core/world/terrain.hpp"

namespace headland {

/// A line that a vehicle drives at work: the centre of an alley, or a swath.
struct Row {
  std::string id;
  Polyline line;  ///< at least two points [m, map]
};

/// A row of a farm, by number.
struct RowRef {
  int parcel = 0;  ///< in Farm::row_parcels
  int row = 0;     ///< in that parcel's rows
};

/// A block of rows. Vehicles turn inside the boundary beyond the rows' ends, and up to
/// `headland_outside_m` beyond the boundary.
struct RowParcel {
  std::string id;
  std::string name;
  Polygon boundary;
  double row_spacing_m = 0.0;    ///< between neighbouring rows
  double row_heading_rad = 0.0;  ///< counter-clockwise from east
  double headland_width_m =
      0.0;  ///< strip inside the boundary kept free at the ends of generated rows
  double headland_outside_m = 0.0;  ///< strip beyond the boundary where vehicles may drive
  std::vector<Row> rows;            ///< given in the file, or else generated on loading
};

struct FreeParcel {
  std::string id;
  Polygon boundary;
};

/// Drivable strip along a line.
struct Road {
  std::string id;
  Polyline line;
  double width_m = 4.0;
};

struct KeepOut {
  std::string id;
  Polygon boundary;
};

struct Gate {
  std::string id;
  Point2 position{0.0, 0.0};
  double width_m = 4.0;
};

/// A named place with a role: warehouse, dock, observation, ...
struct Poi {
  std::string id;
  std::string role;
  Pose2 pose;  ///< in which a vehicle stands there
};

struct Charger {
  std::string id;
  Pose2 pose;  ///< in which a vehicle charges; it drives in and out forwards
  ChargeCurve curve{10000.0};
  int slots = 1;  ///< vehicles at a time
};

/// An area of one soil.
struct SoilArea {
  std::string id;
  SoilClass soil = SoilClass::kFirm;
  Polygon boundary;
};

/// A farm in its local frame; what farm files and importers produce and everything else reads.
struct Farm {
  std::string name;
  LocalFrame frame;
  std::vector<RowParcel> row_parcels;
  std::vector<FreeParcel> free_parcels;
  std::vector<Road> roads;
  std::vector<KeepOut> keep_outs;
  std::vector<Gate> gates;
  std::vector<Poi> pois;
  std::vector<Charger> chargers;
  std::vector<SoilArea> soils;             ///< later ones lie on top of earlier ones
  std::vector<std::string> terrain_files;  ///< GeoTIFFs; opened by load_ground
  std::optional<HillSpec> hills;           ///< generated terrain, where there is no file

  /// The parcel, POI or charger of that id, or null.
  const RowParcel* find_parcel(std::string_view id) const;
  const Row& row(RowRef ref) const;
  /// "parcel/row": unique in the farm, as messages, plans and missions name a row.
  std::string row_name(RowRef ref) const;
  /// All rows, parcel by parcel.
  std::vector<RowRef> all_rows() const;
  const Poi* find_poi(std::string_view id) const;
  const Charger* find_charger(std::string_view id) const;
};

/// Where vehicles may be at all: parcels with their outside headlands, free parcels, roads, gates
/// (discs of their width), and 4 m around POIs and chargers; without keep-outs.
std::vector<Polygon> drivable_area(const Farm& farm);

/// The rectangle around all of that; empty for an empty farm.
MapBox extent(const Farm& farm);

}  // namespace headland
