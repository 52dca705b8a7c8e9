// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/result.hpp"
#include "core/geometry/polygon.hpp"
#include "core/world/geodesy.hpp"

namespace headland::internal {

/// One element of a FeatureCollection, and where it stands: file, line of its first brace, and the
/// key "features.3".
struct Feature {
  Location where;
  nlohmann::json properties;
  nlohmann::json geometry;
};

/// A farm file as read, before its features are understood.
struct Document {
  std::filesystem::path file;
  bool is_headland = false;  ///< it has a `headland` object: our own schema
  std::string name;
  std::optional<LatLon> origin;
  std::vector<Feature> features;
};

/// Reads a file and checks its form as a GeoJSON FeatureCollection, with a `headland` object or
/// with the classes of AGRIDS.
Result<Document> read_document(const std::filesystem::path& file);

/// Centre of the bounding box of all positions; none where there is no position.
std::optional<LatLon> center_of(const std::vector<Feature>& features);

// The feature's geometry in the local frame. Several parts of a MultiPolygon must unite to one.
Result<Polygon> polygon_of(const Feature& feature, const LocalFrame& frame);
Result<Polyline> line_of(const Feature& feature, const LocalFrame& frame);
Result<Point2> point_of(const Feature& feature, const LocalFrame& frame);

/// `where` with ".key" behind its key.
Location below(Location where, const std::string& key);

/// "a list", "'3'", ...: for messages about values of the wrong type.
std::string describe(const nlohmann::json& value);

}  // namespace headland::internal
