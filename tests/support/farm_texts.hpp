// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/world/farm_io.hpp"

// Farm files of a few features, written down in metres.
namespace headland::test {

// Writes a text to a file of the running test and loads it; messages then begin with `farm.geojson`
// without its folder.
inline Result<Farm> load_texts(const std::vector<std::string>& texts, FarmDefaults defaults = {}) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(::testing::TempDir()) /
                      (std::string("headland_farm_io_") + test->name());
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> files;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    files.push_back(folder / (i == 0 ? "farm.geojson" : "more.geojson"));
    std::ofstream(files.back()) << texts[i];
  }
  auto farm = load_farm(files, defaults);
  if (!farm) {
    auto& file = farm.error().where.file;
    file = std::filesystem::path(file).filename().string();
  }
  std::filesystem::remove_all(folder);
  return farm;
}

// A farm file: line 1 the header, one feature on each further line.
inline std::string collection(const std::vector<std::string>& features,
                              const std::string& header =
                                  R"("headland": {"version": 1, "name": "Test",)"
                                  R"( "origin": [3.0, 42.0]})") {
  std::string text = R"({"type": "FeatureCollection", )" + header + R"(, "features": [)";
  for (std::size_t i = 0; i < features.size(); ++i) text += (i == 0 ? "\n" : ",\n") + features[i];
  return text + "]}\n";
}

inline std::string feature(const std::string& properties, const std::string& geometry) {
  return R"({"type": "Feature", "properties": {)" + properties + R"(}, "geometry": )" + geometry +
         "}";
}

inline std::string coordinates(const Polyline& points) {
  const LocalFrame frame({42.0, 3.0});
  std::string text;
  for (const Point2& p : points) {
    const LatLon q = frame.to_wgs84(p);
    text += fmt::format("{}[{:.9f}, {:.9f}]", text.empty() ? "" : ", ", q.lon_deg, q.lat_deg);
  }
  return text;
}
inline std::string polygon(Polyline ring) {
  ring.push_back(ring.front());
  return R"({"type": "Polygon", "coordinates": [[)" + coordinates(ring) + "]]}";
}
inline std::string line(const Polyline& points) {
  return R"({"type": "LineString", "coordinates": [)" + coordinates(points) + "]}";
}
inline std::string point(const Point2& p) {
  return R"({"type": "Point", "coordinates": )" + coordinates({p}) + "}";
}
inline std::string square(double x, double y, double side) {
  return polygon({{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}});
}

inline const std::string kParcelKeys =
    R"("kind": "row_parcel", "id": "p1", "row_spacing_m": 4, "row_heading_deg": 90)";

inline std::string error_of(const std::vector<std::string>& features) {
  const auto farm = load_texts({collection(features)});
  return farm ? "no error" : to_string(farm.error());
}

}  // namespace headland::test
