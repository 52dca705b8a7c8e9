// SPDX-License-Identifier: Apache-2.0
#include "core/world/internal/geojson.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "core/config/messages.hpp"
#include "core/world/internal/properties.hpp"

namespace headland::internal {
namespace {

using nlohmann::json;

constexpr double kFarthest = 50e3;  // [m] from the origin: the local plane ends somewhere

int line_at(const std::string& text, std::size_t offset) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text.size()));
  return 1 + static_cast<int>(std::count(text.begin(), end, '\n'));
}

// The line of each element of the top-level array "features". The text is valid JSON.
std::vector<int> feature_lines(const std::string& text) {
  std::vector<int> lines;
  std::string key;      // the last string at the top level
  bool inside = false;  // of "features"
  int depth = 0;
  int line = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (c == '"') {
      const std::size_t begin = ++i;
      while (text[i] != '"') i += text[i] == '\\' ? 2 : 1;
      if (depth == 1) key = text.substr(begin, i - begin);
    } else if (c == '{' || c == '[') {
      if (depth == 1) inside = c == '[' && key == "features";
      if (depth == 2 && inside) lines.push_back(line);
      ++depth;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return lines;
}

Result<std::string> read_text(const std::filesystem::path& file) {
  const Location where{file.string(), 0, ""};
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code)) {
    return fail(ErrorCode::kFileNotFound, "no such file", "check the path", where);
  }
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  if (!stream) {
    return fail(ErrorCode::kFileNotFound, "the file cannot be read", "check its permissions",
                where);
  }
  return text.str();
}

Result<json> parse(const std::string& text, const std::string& name) {
  try {
    return json::parse(text);
  } catch (const json::parse_error& e) {
    const std::string message = e.what();
    const std::size_t at = message.find("syntax error");
    return fail(ErrorCode::kSyntax,
                "not valid JSON: " + (at == std::string::npos ? message : message.substr(at)),
                "correct the line", Location{name, line_at(text, e.byte), ""});
  } catch (const json::exception& e) {  // such as a number beyond the range of double
    return fail(ErrorCode::kSyntax, std::string("not valid JSON: ") + e.what(), "",
                Location{name, 0, ""});
  }
}

// The `headland` object: {"version": 1, "name": "...", "origin": [lon, lat]}.
Result<void> read_header(const json& header, const Location& where, Document& document) {
  const Location here = below(where, "headland");
  if (!header.is_object()) {
    return fail(ErrorCode::kWrongType, describe(header) + " is not an object", "", here);
  }
  document.is_headland = true;
  Properties properties(header, here);
  const int version = properties.whole("version", config::Range{1.0, 1000.0}, Need::kRequired, 1);
  document.name = properties.text("name", Need::kOptional);
  const json origin = properties.raw("origin");
  if (auto ok = properties.finish(); !ok) return ok;
  if (version != 1) {
    return fail(ErrorCode::kUnsupported, fmt::format("{} is not supported", version),
                "this program reads version 1", below(here, "version"));
  }
  if (origin.is_null()) return {};
  if (!origin.is_array() || origin.size() != 2 || !origin[0].is_number() ||
      !origin[1].is_number()) {
    return fail(ErrorCode::kWrongType, describe(origin) + " is not a position", "[lon, lat]",
                below(here, "origin"));
  }
  document.origin = LatLon{origin[1].get<double>(), origin[0].get<double>()};
  if (std::abs(document.origin->lat_deg) > 90.0 || std::abs(document.origin->lon_deg) > 180.0) {
    return fail(ErrorCode::kOutOfRange, origin.dump() + " is out of range", "[lon, lat] in degrees",
                below(here, "origin"));
  }
  return {};
}

Result<Feature> read_feature(json& element, Location where) {
  if (!element.is_object()) {
    return fail(ErrorCode::kWrongType, describe(element) + " is not a Feature", "", where);
  }
  if (element.value("type", json()) != "Feature") {
    return fail(ErrorCode::kWrongType,
                describe(element.value("type", json())) + " is not 'Feature'", "",
                below(where, "type"));
  }
  if (!element.contains("properties") || !element["properties"].is_object()) {
    return fail(ErrorCode::kMissingKey, "required key is missing", "an object with a kind",
                below(where, "properties"));
  }
  return Feature{std::move(where), std::move(element["properties"]),
                 element.contains("geometry") ? std::move(element["geometry"]) : json()};
}

bool looks_like_agrids(const std::vector<Feature>& features) {
  return std::any_of(features.begin(), features.end(), [](const Feature& f) {
    return f.properties.contains("class") && f.properties["class"].is_string();
  });
}

// Positions below any depth of nesting.
void collect_positions(const json& coordinates, std::vector<LatLon>& out) {
  if (!coordinates.is_array()) return;
  if (coordinates.size() >= 2 && coordinates[0].is_number() && coordinates[1].is_number()) {
    out.push_back({coordinates[1].get<double>(), coordinates[0].get<double>()});
    return;
  }
  for (const json& inner : coordinates) collect_positions(inner, out);
}

Result<Point2> read_position(const json& position, const LocalFrame& frame, const Location& where) {
  if (!position.is_array() || position.size() < 2 || !position[0].is_number() ||
      !position[1].is_number()) {
    return fail(ErrorCode::kWrongType, describe(position) + " is not a position", "[lon, lat]",
                where);
  }
  const LatLon wgs84{position[1].get<double>(), position[0].get<double>()};
  if (std::abs(wgs84.lat_deg) > 90.0 || std::abs(wgs84.lon_deg) > 180.0) {
    return fail(ErrorCode::kOutOfRange,
                fmt::format("[{}, {}] is out of range", wgs84.lon_deg, wgs84.lat_deg),
                "[lon, lat] in degrees", where);
  }
  const Point2 p_map = frame.to_map(wgs84);
  if (!(p_map.norm() < kFarthest)) {
    return fail(ErrorCode::kOutOfRange,
                fmt::format("[{}, {}] lies {:.0f} km from the farm's origin", wgs84.lon_deg,
                            wgs84.lat_deg, p_map.norm() / 1000.0),
                "positions are [lon, lat], and a farm spans 50 km at most", where);
  }
  return p_map;
}

Result<Polyline> read_line(const json& coordinates, const LocalFrame& frame,
                           const Location& where) {
  if (!coordinates.is_array()) {
    return fail(ErrorCode::kWrongType, describe(coordinates) + " is not a list of positions", "",
                where);
  }
  Polyline line;
  for (const json& position : coordinates) {
    auto p_map = read_position(position, frame, where);
    if (!p_map) return tl::unexpected<Error>(p_map.error());
    line.push_back(*p_map);
  }
  return line;
}

Result<Polygon> read_polygon(const json& rings, const LocalFrame& frame, const Location& where) {
  if (!rings.is_array() || rings.empty()) {
    return fail(ErrorCode::kBadGeometry, "the polygon has no rings", "", where);
  }
  Polygon polygon;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    auto ring = read_line(rings[i], frame, where);
    if (!ring) return tl::unexpected<Error>(ring.error());
    (i == 0 ? polygon.outer : polygon.holes.emplace_back()) = std::move(*ring);
  }
  auto result = checked(std::move(polygon));
  if (!result) result.error().where = where;
  return result;
}

// The geometry's coordinates, where its type is one of the wanted.
Result<const json*> coordinates_of(const Feature& feature, const std::vector<std::string>& types) {
  const Location where = below(feature.where, "geometry");
  if (feature.geometry.is_null()) {
    return fail(ErrorCode::kMissingKey, "required key is missing",
                fmt::format("a {}", fmt::join(types, " or ")), where);
  }
  const json type = feature.geometry.is_object() ? feature.geometry.value("type", json()) : json();
  if (std::none_of(types.begin(), types.end(), [&](const auto& t) { return type == t; })) {
    return fail(ErrorCode::kWrongType, describe(type) + " is not the geometry of this kind",
                fmt::format("allowed: {}", fmt::join(types, ", ")), below(where, "type"));
  }
  const auto coordinates = feature.geometry.find("coordinates");
  if (coordinates == feature.geometry.end()) {
    return fail(ErrorCode::kMissingKey, "required key is missing", "", below(where, "coordinates"));
  }
  return &*coordinates;
}

}  // namespace

Location below(Location where, const std::string& key) {
  where.key += (where.key.empty() ? "" : ".") + key;
  return where;
}

std::string describe(const json& value) {
  if (value.is_null()) return "nothing";
  if (value.is_object()) return "an object";
  if (value.is_array()) return "a list";
  if (value.is_string()) return "'" + value.get<std::string>() + "'";
  return value.dump();
}

Result<Document> read_document(const std::filesystem::path& file) {
  const auto text = read_text(file);
  if (!text) return tl::unexpected<Error>(text.error());
  auto root = parse(*text, file.string());
  if (!root) return tl::unexpected<Error>(root.error());
  const Location top{file.string(), 1, ""};
  if (!root->is_object() || root->value("type", json()) != "FeatureCollection") {
    return fail(ErrorCode::kWrongType, "not a GeoJSON FeatureCollection",
                R"(it begins {"type": "FeatureCollection")", top);
  }
  Document document;
  document.file = file;
  if (root->contains("headland")) {
    if (auto ok = read_header((*root)["headland"], top, document); !ok) {
      return tl::unexpected<Error>(ok.error());
    }
  }
  const auto features = root->find("features");
  if (features == root->end() || !features->is_array() || features->empty()) {
    return fail(ErrorCode::kMissingKey, "the collection is empty", "a farm has a feature or more",
                below(top, "features"));
  }
  const std::vector<int> lines = feature_lines(*text);
  for (std::size_t i = 0; i < features->size(); ++i) {
    // Elements that are no objects or lists have no line of their own; they are errors anyway.
    const int line = lines.size() == features->size() ? lines[i] : 0;
    auto feature =
        read_feature((*features)[i], Location{file.string(), line, fmt::format("features.{}", i)});
    if (!feature) return tl::unexpected<Error>(feature.error());
    document.features.push_back(std::move(*feature));
  }
  if (!document.is_headland && !looks_like_agrids(document.features)) {
    return fail(ErrorCode::kMissingKey, "required key is missing",
                R"(a farm file has "headland": {"version": 1}, or features with an AGRIDS class)",
                below(top, "headland"));
  }
  return document;
}

std::optional<LatLon> center_of(const std::vector<Feature>& features) {
  std::vector<LatLon> all;
  for (const Feature& feature : features) {
    if (feature.geometry.is_object() && feature.geometry.contains("coordinates")) {
      collect_positions(feature.geometry["coordinates"], all);
    }
  }
  if (all.empty()) return std::nullopt;
  const auto by_lat = [](LatLon a, LatLon b) { return a.lat_deg < b.lat_deg; };
  const auto by_lon = [](LatLon a, LatLon b) { return a.lon_deg < b.lon_deg; };
  const auto [south, north] = std::minmax_element(all.begin(), all.end(), by_lat);
  const auto [west, east] = std::minmax_element(all.begin(), all.end(), by_lon);
  const LatLon center{0.5 * (south->lat_deg + north->lat_deg),
                      0.5 * (west->lon_deg + east->lon_deg)};
  // Positions out of range are reported with their feature, later.
  return LatLon{std::clamp(center.lat_deg, -90.0, 90.0), std::clamp(center.lon_deg, -180.0, 180.0)};
}

Result<Polygon> polygon_of(const Feature& feature, const LocalFrame& frame) {
  const Location where = below(feature.where, "geometry");
  const auto coordinates = coordinates_of(feature, {"Polygon", "MultiPolygon"});
  if (!coordinates) return tl::unexpected<Error>(coordinates.error());
  if (feature.geometry["type"] == "Polygon") return read_polygon(**coordinates, frame, where);
  std::vector<Polygon> parts;
  if ((*coordinates)->is_array()) {
    for (const json& rings : **coordinates) {
      auto part = read_polygon(rings, frame, where);
      if (!part) return part;
      parts.push_back(std::move(*part));
    }
  }
  if (parts.size() == 1) return parts.front();
  parts = unite(parts);
  if (parts.size() == 1) return parts.front();
  return fail(ErrorCode::kBadGeometry, fmt::format("{} separate areas", parts.size()),
              "the parts of a MultiPolygon must touch; give each area a feature of its own", where);
}

Result<Polyline> line_of(const Feature& feature, const LocalFrame& frame) {
  const Location where = below(feature.where, "geometry");
  const auto coordinates = coordinates_of(feature, {"LineString"});
  if (!coordinates) return tl::unexpected<Error>(coordinates.error());
  auto line = read_line(**coordinates, frame, where);
  if (!line) return line;
  line->erase(std::unique(line->begin(), line->end()), line->end());
  if (line->size() < 2) {
    return fail(ErrorCode::kBadGeometry, "the line has no length", "give two points or more",
                where);
  }
  return line;
}

Result<Point2> point_of(const Feature& feature, const LocalFrame& frame) {
  const auto coordinates = coordinates_of(feature, {"Point"});
  if (!coordinates) return tl::unexpected<Error>(coordinates.error());
  return read_position(**coordinates, frame, below(feature.where, "geometry"));
}

}  // namespace headland::internal
