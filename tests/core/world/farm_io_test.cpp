// SPDX-License-Identifier: Apache-2.0
#include "core/world/farm_io.hpp"

#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// Writes a text to a file of the running test and loads it; messages then begin with `farm.geojson`
// without its folder.
Result<Farm> load_texts(const std::vector<std::string>& texts, FarmDefaults defaults = {}) {
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
std::string collection(const std::vector<std::string>& features,
                       const std::string& header = R"("headland": {"version": 1, "name": "Test",)"
                                                   R"( "origin": [3.0, 42.0]})") {
  std::string text = R"({"type": "FeatureCollection", )" + header + R"(, "features": [)";
  for (std::size_t i = 0; i < features.size(); ++i) text += (i == 0 ? "\n" : ",\n") + features[i];
  return text + "]}\n";
}

std::string feature(const std::string& properties, const std::string& geometry) {
  return R"({"type": "Feature", "properties": {)" + properties + R"(}, "geometry": )" + geometry +
         "}";
}

std::string coordinates(const Polyline& points) {
  const LocalFrame frame({42.0, 3.0});
  std::string text;
  for (const Point2& p : points) {
    const LatLon q = frame.to_wgs84(p);
    text += fmt::format("{}[{:.9f}, {:.9f}]", text.empty() ? "" : ", ", q.lon_deg, q.lat_deg);
  }
  return text;
}
std::string polygon(Polyline ring) {
  ring.push_back(ring.front());
  return R"({"type": "Polygon", "coordinates": [[)" + coordinates(ring) + "]]}";
}
std::string line(const Polyline& points) {
  return R"({"type": "LineString", "coordinates": [)" + coordinates(points) + "]}";
}
std::string point(const Point2& p) {
  return R"({"type": "Point", "coordinates": )" + coordinates({p}) + "}";
}
std::string square(double x, double y, double side) {
  return polygon({{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}});
}

const std::string kParcelKeys =
    R"("kind": "row_parcel", "id": "p1", "row_spacing_m": 4, "row_heading_deg": 90)";

std::string error_of(const std::vector<std::string>& features) {
  const auto farm = load_texts({collection(features)});
  return farm ? "no error" : to_string(farm.error());
}

TEST(FarmIo, ReadsEveryKindWithItsProperties) {
  const auto farm = load_texts({collection({
      feature(kParcelKeys + R"(, "name": "Apples", "headland_width_m": 5, "headland_outside_m": 2)",
              square(0, 0, 100)),
      feature(R"("kind": "row_parcel", "id": "p2")", square(200, 0, 50)),
      feature(R"("kind": "row", "parcel": "p2", "id": "a")", line({{210, 5}, {210, 45}})),
      feature(R"("kind": "row", "parcel": "p2")", line({{213, 45}, {213, 5}})),
      feature(R"("kind": "free_parcel", "id": "yard")", square(-50, 0, 30)),
      feature(R"("kind": "road", "width_m": 5)", line({{-20, 10}, {0, 10}})),
      feature(R"("kind": "keep_out", "id": "shed")", square(-50, 0, 5)),
      feature(R"("kind": "gate", "width_m": 3.5)", point({0, 10})),
      feature(R"("kind": "poi", "id": "w", "role": "warehouse", "heading_deg": 180)",
              point({-40, 10})),
      feature(R"("kind": "charger", "id": "c", "power_w": 22000, "slots": 2, "heading_deg": -90)",
              point({-30, 20})),
      feature(R"("kind": "terrain", "path": "dem.tif")", "null"),
      feature(R"("kind": "soil", "id": "wet", "class": "soft")", square(10, 10, 20)),
      feature(R"("kind": "soil", "class": "sand")", square(20, 10, 20)),
  })});
  ASSERT_TRUE(farm) << to_string(farm.error());
  EXPECT_EQ(farm->name, "Test");
  EXPECT_EQ(farm->frame.origin().lat_deg, 42.0);
  EXPECT_EQ(farm->frame.origin().lon_deg, 3.0);
  ASSERT_EQ(farm->row_parcels.size(), 2u);
  const RowParcel& generated = farm->row_parcels[0];
  EXPECT_EQ(generated.name, "Apples");
  EXPECT_EQ(generated.rows.size(), 25u);
  EXPECT_NEAR(length(generated.rows[0].line), 90.0, 1e-3);
  EXPECT_EQ(generated.headland_outside_m, 2.0);
  EXPECT_NEAR(generated.row_heading_rad, kPi / 2, 1e-12);
  const RowParcel& given = farm->row_parcels[1];
  ASSERT_EQ(given.rows.size(), 2u);
  EXPECT_EQ(given.rows[0].id, "a");
  EXPECT_EQ(given.rows[1].id, "r2");
  EXPECT_NEAR(given.row_spacing_m, 3.0, 1e-3);        // estimated
  EXPECT_NEAR(given.row_heading_rad, kPi / 2, 1e-4);  // that of the first row
  EXPECT_GT(given.rows[1].line.front().y(), 40.0);    // drawn the other way, and kept so
  ASSERT_EQ(farm->roads.size(), 1u);
  EXPECT_EQ(farm->roads[0].id, "road-1");
  EXPECT_EQ(farm->roads[0].width_m, 5.0);
  EXPECT_EQ(farm->gates[0].id, "gate-1");
  EXPECT_EQ(farm->gates[0].width_m, 3.5);
  EXPECT_NEAR(area(farm->keep_outs[0].boundary), 25.0, 1e-2);
  EXPECT_NEAR(area(farm->free_parcels[0].boundary), 900.0, 0.1);
  ASSERT_NE(farm->find_poi("w"), nullptr);
  EXPECT_EQ(farm->find_poi("w")->role, "warehouse");
  EXPECT_NEAR(farm->find_poi("w")->pose.x, -40.0, 1e-3);
  EXPECT_NEAR(farm->find_poi("w")->pose.yaw, kPi, 1e-12);
  ASSERT_NE(farm->find_charger("c"), nullptr);
  EXPECT_EQ(farm->find_charger("c")->curve.max_power(), 22000.0);
  EXPECT_EQ(farm->find_charger("c")->slots, 2);
  ASSERT_EQ(farm->terrain_files.size(), 1u);
  EXPECT_EQ(std::filesystem::path(farm->terrain_files[0]).filename(), "dem.tif");
  EXPECT_GT(farm->terrain_files[0].size(), 7u);  // beside the farm file
  EXPECT_FALSE(farm->hills);
  ASSERT_EQ(farm->soils.size(), 2u);  // in the file's order: later ones lie on top
  EXPECT_EQ(farm->soils[0].id, "wet");
  EXPECT_EQ(farm->soils[0].soil, SoilClass::kSoft);
  EXPECT_EQ(farm->soils[1].id, "soil-1");
  EXPECT_EQ(farm->soils[1].soil, SoilClass::kSand);
  EXPECT_NEAR(area(farm->soils[1].boundary), 400.0, 0.1);
}

TEST(FarmIo, ChargersGiveConstantPowerOrACurve) {
  const auto curve = [](const std::string& power) {
    const auto farm = load_texts({collection(
        {feature(R"("kind": "charger", "id": "c", "power_w": )" + power, point({0, 0}))})});
    EXPECT_TRUE(farm) << to_string(farm.error());
    return farm->chargers[0].curve;
  };
  EXPECT_EQ(curve("5000").power(0.3), 5000.0);
  const ChargeCurve falling = curve("[[0, 22000], [0.8, 22000], [1, 3000]]");
  ASSERT_EQ(falling.points().size(), 3u);
  EXPECT_EQ(falling.power(0.5), 22000.0);
  EXPECT_NEAR(falling.power(0.9), 12500.0, 1e-9);
  EXPECT_EQ(curve("[[0.5, 700]]").power(0.9), 700.0);
}

TEST(FarmIo, HillsMayBeGenerated) {
  const auto hills = [](const std::string& text) {
    return load_texts({collection({feature(R"("kind": "terrain", )" + text, "null")})});
  };
  const auto farm =
      hills(R"("hills_seed": 7, "hills_relief_m": 35, "hills_wavelength_m": 150, "cell_m": 1)");
  ASSERT_TRUE(farm) << to_string(farm.error());
  ASSERT_TRUE(farm->hills);
  EXPECT_EQ(farm->hills->seed, 7u);
  EXPECT_EQ(farm->hills->relief_m, 35.0);
  EXPECT_EQ(farm->hills->wavelength_m, 150.0);
  EXPECT_EQ(farm->hills->cell_m, 1.0);
  EXPECT_TRUE(farm->terrain_files.empty());
  EXPECT_EQ(hills(R"("hills_seed": 3)")->hills->cell_m, HillSpec{}.cell_m);
}

TEST(FarmIo, DefaultsFillWhatTheFileLeavesOut) {
  const auto farm = load_texts({collection({
                                   feature(kParcelKeys, square(0, 0, 50)),
                                   feature(R"("kind": "charger", "id": "c")", point({0, 0})),
                                   feature(R"("kind": "road")", line({{0, 0}, {9, 0}})),
                               })},
                               {.headland_outside_m = 7.0});
  ASSERT_TRUE(farm) << to_string(farm.error());
  EXPECT_EQ(farm->row_parcels[0].headland_outside_m, 7.0);
  EXPECT_EQ(farm->row_parcels[0].headland_width_m, 0.0);
  EXPECT_EQ(farm->chargers[0].curve.max_power(), 10000.0);
  EXPECT_EQ(farm->chargers[0].slots, 1);
  EXPECT_EQ(farm->roads[0].width_m, 4.0);
}

TEST(FarmIo, WithoutAnOriginTheCentreOfTheMapIsOne) {
  const auto farm = load_texts(
      {collection({feature(kParcelKeys, square(0, 0, 50))}, R"("headland": {"version": 1})")});
  ASSERT_TRUE(farm) << to_string(farm.error());
  EXPECT_EQ(farm->name, "farm");  // the file's
  Point2 sum(0, 0);
  for (const Point2& p : farm->row_parcels[0].boundary.outer) sum += p;
  EXPECT_LT(sum.norm(), 0.01);
}

TEST(FarmIo, LaterFilesAddToTheFirst) {
  const auto farm = load_texts(
      {collection({feature(kParcelKeys, square(0, 0, 50))}),
       collection({feature(R"("kind": "row", "parcel": "p1")", line({{10, 10}, {10, 40}}))},
                  R"("headland": {"version": 1, "origin": [3.1, 42.1]})")});
  ASSERT_TRUE(farm) << to_string(farm.error());
  ASSERT_EQ(farm->row_parcels[0].rows.size(), 1u);
  EXPECT_NEAR(farm->row_parcels[0].rows[0].line[0].x(), 10.0, 1e-3);
}

TEST(FarmIo, PartsOfAMultiPolygonThatTouchAreOneParcel) {
  const auto multi = [](double gap) {
    const Polyline a{{0, 0}, {30, 0}, {30, 30}, {0, 30}, {0, 0}};
    const Polyline b{{30 + gap, 0}, {60, 0}, {60, 30}, {30 + gap, 30}, {30 + gap, 0}};
    return R"({"type": "MultiPolygon", "coordinates": [[[)" + coordinates(a) + "]], [[" +
           coordinates(b) + "]]]}";
  };
  const auto one = load_texts({collection({feature(kParcelKeys, multi(0.0))})});
  ASSERT_TRUE(one) << to_string(one.error());
  EXPECT_NEAR(area(one->row_parcels[0].boundary), 1800.0, 0.1);
  EXPECT_THAT(error_of({feature(kParcelKeys, multi(1.0))}),
              StartsWith("farm.geojson:2: features.0.geometry: 2 separate areas; "));
}

TEST(FarmIo, WrittenTextReadsBackToTheSameText) {
  auto farm = load_texts({collection({
      feature(kParcelKeys + R"(, "name": "Äpfel \"alt\"", "headland_outside_m": 2.5)",
              polygon({{0, 0}, {90, 10}, {80, 70}, {10, 80}})),
      feature(R"("kind": "free_parcel", "id": "yard")", square(-50, 0, 30)),
      feature(R"("kind": "road", "id": "r", "width_m": 5)", line({{-20, 10}, {-5, 15}, {0, 10}})),
      feature(R"("kind": "keep_out", "id": "shed")", square(-50, 0, 5)),
      feature(R"("kind": "gate", "id": "g", "width_m": 3.5)", point({0, 10})),
      feature(R"("kind": "poi", "id": "w", "role": "dock", "heading_deg": 33.3)", point({-40, 1})),
      feature(R"("kind": "charger", "id": "c", "heading_deg": -120)", point({-30, 20})),
      feature(R"("kind": "terrain", "path": "/data/dem.tif")", "null"),
      feature(R"("kind": "terrain", "hills_seed": 7, "hills_relief_m": 12.5)", "null"),
      feature(R"("kind": "soil", "id": "wet", "class": "tilled")", square(0, 0, 30)),
      feature(R"("kind": "charger", "id": "cv", "power_w": [[0, 9000], [0.7, 9000], [1, 500.5]])",
              point({-30, 25})),
  })});
  ASSERT_TRUE(farm) << to_string(farm.error());
  farm->keep_outs[0].boundary.holes.push_back({{-48, 1}, {-48, 2}, {-47, 1}});
  const std::string text = to_geojson(*farm);
  const auto again = load_texts({text});
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_EQ(to_geojson(*again), text);
  ASSERT_EQ(again->row_parcels[0].rows.size(), farm->row_parcels[0].rows.size());
  EXPECT_LT((again->row_parcels[0].rows[3].line[0] - farm->row_parcels[0].rows[3].line[0]).norm(),
            2e-4);
  EXPECT_EQ(again->keep_outs[0].boundary.holes.size(), 1u);
  EXPECT_EQ(again->name, "Test");
  EXPECT_EQ(again->terrain_files, farm->terrain_files);
  EXPECT_EQ(again->hills->seed, 7u);
  EXPECT_EQ(again->hills->relief_m, 12.5);
  EXPECT_EQ(again->soils[0].soil, SoilClass::kTilled);
  EXPECT_EQ(again->chargers[1].curve.power(1.0), 500.5);
}

TEST(FarmIo, AgridsClassesBecomeOurKinds) {
  const auto agrids = [](const std::string& type, const std::string& more,
                         const std::string& geometry) {
    return feature(R"("class": ")" + type + R"(", "category": "x", "shortCode": )" + more,
                   geometry);
  };
  const auto farm = load_texts({collection(
      {
          agrids("row", R"("r1", "block": "A")", line({{2, 1}, {2, 49}})),
          agrids("row", R"("r2", "block": "A")", line({{5, 49}, {5, 1}})),
          agrids("row", R"("r1", "block": "uuid-b")", line({{110, 1}, {110, 49}})),
          agrids("row", R"(null, "block": "B")", line({{113, 1}, {113, 49}})),
          agrids("block", R"("A", "name": "Bacchus", "id": "uuid-a")", square(0, 0, 50)),
          agrids("block", R"("B", "name": "Pinot", "id": "uuid-b")", square(100, 0, 50)),
          agrids("entrance_exit", "null", point({60, 0})),
          agrids("entrance_exit", "null", point({70, 0})),
          agrids("building", "null", square(200, 0, 10)),
          agrids("conservation", "null", square(220, 0, 10)),
          agrids("toilet", "null", point({230, 40})),
          agrids("drainage_line", "null", line({{0, 0}, {60, 60}})),
          feature(R"("class": "sceptic_tank", "category": "hazardous_material")", point({0, 90})),
      },
      R"("name": "x")")});
  ASSERT_TRUE(farm) << to_string(farm.error());
  ASSERT_EQ(farm->row_parcels.size(), 2u);
  const RowParcel* a = farm->find_parcel("A");
  ASSERT_NE(a, nullptr);
  EXPECT_EQ(a->name, "Bacchus");
  EXPECT_EQ(a->rows.size(), 2u);
  EXPECT_NEAR(a->row_spacing_m, 3.0, 0.01);
  const RowParcel* b = farm->find_parcel("B");
  ASSERT_NE(b, nullptr);
  ASSERT_EQ(b->rows.size(), 2u);
  EXPECT_EQ(b->rows[0].id, "r1-2");  // r1 is taken by block A's
  EXPECT_EQ(b->rows[1].id, "row");
  ASSERT_EQ(farm->gates.size(), 2u);
  EXPECT_NE(farm->gates[0].id, farm->gates[1].id);
  EXPECT_EQ(farm->keep_outs.size(), 2u);
  ASSERT_EQ(farm->pois.size(), 2u);
  EXPECT_EQ(farm->pois[0].role, "toilet");
  EXPECT_EQ(farm->pois[1].role, "sceptic_tank");
}

TEST(FarmIoErrors, AnAbsentFileIsNamed) {
  const auto farm = load_farm({"/no/such/farm.geojson"});
  ASSERT_FALSE(farm);
  EXPECT_EQ(to_string(farm.error()), "/no/such/farm.geojson: no such file; check the path [E101]");
  EXPECT_FALSE(load_farm({}));
}

TEST(FarmIoErrors, BrokenJsonNamesTheLine) {
  const auto farm = load_texts({"{\"type\": \"FeatureCollection\",\n\"features\": [\n}\n"});
  ASSERT_FALSE(farm);
  EXPECT_THAT(to_string(farm.error()), StartsWith("farm.geojson:3: not valid JSON: "));
  EXPECT_EQ(farm.error().code, ErrorCode::kSyntax);
  for (const char* text : {"", "{", "[1, 2", "{\"type\": \"Feature", "\xff\xfe", "1e999"}) {
    const auto bad = load_texts({text});
    ASSERT_FALSE(bad) << text;
    EXPECT_EQ(bad.error().code, ErrorCode::kSyntax) << text;
  }
}

TEST(FarmIoErrors, WhatIsNoFarmIsRefused) {
  for (const char* text :
       {"[]", "3", "{}", R"({"type": "Feature"})", R"({"type": "FeatureCollection"})",
        R"({"type": "FeatureCollection", "features": {}})",
        R"({"type": "FeatureCollection", "features": [1]})",
        R"({"type": "FeatureCollection", "features": [{"type": "x"}]})"}) {
    EXPECT_FALSE(load_texts({text})) << text;
  }
  EXPECT_THAT(error_of({}), HasSubstr("features: the collection is empty"));
  EXPECT_THAT(
      to_string(
          load_texts({collection({feature(kParcelKeys, square(0, 0, 50))}, R"("a": 1)")}).error()),
      StartsWith("farm.geojson:1: headland: required key is missing; "));
}

TEST(FarmIoErrors, HeaderIsChecked) {
  const auto error_with = [](const std::string& header) {
    const auto farm = load_texts(
        {collection({feature(kParcelKeys, square(0, 0, 50))}, "\"headland\": " + header)});
    return farm ? "no error" : to_string(farm.error());
  };
  EXPECT_THAT(error_with("{}"), HasSubstr("headland.version: required key is missing"));
  EXPECT_THAT(error_with(R"({"version": 2})"), HasSubstr("headland.version: 2 is not supported"));
  EXPECT_THAT(error_with(R"({"version": "1"})"), HasSubstr("'1' is not a whole number"));
  EXPECT_THAT(error_with(R"({"version": 1, "nam": "x"})"), HasSubstr("did you mean 'name'?"));
  EXPECT_THAT(error_with(R"({"version": 1, "origin": 5})"), HasSubstr("5 is not a position"));
  EXPECT_THAT(error_with(R"({"version": 1, "origin": [3, 100]})"), HasSubstr("out of range"));
  EXPECT_THAT(error_with("7"), HasSubstr("headland: 7 is not an object"));
}

TEST(FarmIoErrors, BadValuesNameFileLineAndKey) {
  const std::string good = feature(R"("kind": "gate")", point({0, 0}));
  const auto spacing = [&](const std::string& value) {
    return error_of({good, good, good,
                     feature(R"("kind": "row_parcel", "id": "p", "row_heading_deg": 0,)"
                             R"( "row_spacing_m": )" +
                                 value,
                             square(0, 0, 50))});
  };
  const std::string place = "farm.geojson:5: features.3.properties.row_spacing_m: ";
  EXPECT_EQ(spacing("0"), place + "0 is out of range; must be greater than 0 [E106]");
  EXPECT_EQ(spacing("-2.5"), place + "-2.5 is out of range; must be greater than 0 [E106]");
  EXPECT_EQ(spacing("\"wide\""), place + "'wide' is not a number [E105]");
  EXPECT_THAT(spacing("1e-7"), HasSubstr("row_spacing_m: 1e-07 makes 5"));
  EXPECT_THAT(spacing("40"), StartsWith("farm.geojson:5: features.3.properties: no row longer "));
}

TEST(FarmIoErrors, LinesCountFromWhereTheFeatureBegins) {
  const auto farm = load_texts(
      {"{\"type\": \"FeatureCollection\",\n \"note\": {\"features\": [{}, \"]\\\"\"]},\n"
       " \"headland\":\n  {\"version\": 1},\n \"features\":\n [\n  {\"type\": \"Feature\",\n"
       "   \"properties\": {\"kind\": \"gate\"},\n   \"geometry\":\n   " +
       point({0, 0}) + "},\n" +
       "  {\"type\": \"Feature\",\n   \"properties\":\n   {\"kind\": \"gat\"}}]}"});
  ASSERT_FALSE(farm);
  EXPECT_EQ(to_string(farm.error()),
            "farm.geojson:11: features.1.properties.kind: 'gat' is not a known kind; did you mean "
            "'gate'? [E108]");
}

TEST(FarmIoErrors, UnknownKeysAndKinds) {
  EXPECT_EQ(error_of({feature(R"("kind": "road", "widht_m": 5)", line({{0, 0}, {9, 0}}))}),
            "farm.geojson:2: features.0.properties.widht_m: unknown key; did you mean 'width_m'? "
            "[E103]");
  EXPECT_EQ(error_of({feature(R"("kind": "road", "colour": "red")", line({{0, 0}, {9, 0}}))}),
            "farm.geojson:2: features.0.properties.colour: unknown key; allowed: kind, id, width_m "
            "[E103]");
  EXPECT_THAT(error_of({feature(R"("kind": "volcano")", point({0, 0}))}),
              StartsWith("farm.geojson:2: features.0.properties.kind: 'volcano' is not a known "
                         "kind; allowed: row_parcel, row, "));
  EXPECT_THAT(error_of({feature(R"("kind": 3)", point({0, 0}))}),
              HasSubstr("kind: 3 is not a known kind; allowed: "));
  EXPECT_THAT(error_of({feature(R"("id": "x")", point({0, 0}))}),
              HasSubstr("kind: required key is missing; allowed: "));
}

TEST(FarmIoErrors, MissingKeys) {
  EXPECT_THAT(error_of({feature(R"("kind": "row_parcel")", square(0, 0, 50))}),
              HasSubstr("features.0.properties.id: required key is missing"));
  EXPECT_THAT(error_of({feature(R"("kind": "row_parcel", "id": "p")", square(0, 0, 50))}),
              HasSubstr("features.0.properties.row_spacing_m: required key is missing"));
  EXPECT_THAT(error_of({feature(R"("kind": "row_parcel", "id": "p", "row_spacing_m": 3)",
                                square(0, 0, 50))}),
              HasSubstr("features.0.properties.row_heading_deg: required key is missing"));
  EXPECT_THAT(error_of({feature(R"("kind": "poi", "id": "p")", point({0, 0}))}),
              HasSubstr("features.0.properties.role: required key is missing"));
  EXPECT_THAT(error_of({feature(R"("kind": "poi", "id": "", "role": "x")", point({0, 0}))}),
              HasSubstr("features.0.properties.id: the text is empty"));
  EXPECT_THAT(error_of({feature(R"("kind": "charger", "id": "c", "slots": 0)", point({0, 0}))}),
              HasSubstr("features.0.properties.slots: 0 is out of range"));
  EXPECT_THAT(
      error_of({feature(kParcelKeys + R"(, "headland_outside_m": 1e300)", square(0, 0, 9))}),
      HasSubstr("headland_outside_m: 1e+300 is out of range; allowed: 0 to 1000"));
  EXPECT_THAT(error_of({feature(R"("kind": "charger", "id": "c", "slots": 1.5)", point({0, 0}))}),
              HasSubstr("features.0.properties.slots: 1.5 is not a whole number"));
}

TEST(FarmIoErrors, ChargingCurvesAreChecked) {
  const auto power = [](const std::string& value) {
    return error_of(
        {feature(R"("kind": "charger", "id": "c", "power_w": )" + value, point({0, 0}))});
  };
  const std::string place = "farm.geojson:2: features.0.properties.power_w: ";
  EXPECT_EQ(power("[]"), place + "the list is empty; at least one pair [soc, power] [E106]");
  EXPECT_EQ(power("[[0, 5], [1]]"), place + "[1] is not a pair [soc, power] [E105]");
  EXPECT_EQ(power("[[0, \"5\"]]"), place + "[0,\"5\"] is not a pair [soc, power] [E105]");
  for (const char* list : {"[[0.5, 5], [0.5, 4]]", "[[0, 5], [1.1, 4]]", "[[-0.1, 5]]",
                           "[[0, 5], [1, 0]]", "[[0.8, 5], [0.2, 4]]", "[[0, 1e9]]"}) {
    EXPECT_THAT(power(list), HasSubstr("is out of range or order; [soc, power] with soc")) << list;
  }
  EXPECT_THAT(power("0"), StartsWith(place + "0 is out of range"));
  EXPECT_THAT(power("\"fast\""), StartsWith(place + "'fast' is not a number"));
}

TEST(FarmIoErrors, TerrainAndSoilAreChecked) {
  const auto terrain = [](const std::string& properties) {
    return error_of({feature(R"("kind": "terrain")" + properties, "null")});
  };
  EXPECT_THAT(terrain(""), HasSubstr("properties.path: required key is missing"));
  EXPECT_THAT(terrain(R"(, "hills_seed": 0.5)"), HasSubstr("hills_seed: 0.5 is not a whole numb"));
  EXPECT_THAT(terrain(R"(, "path": "a.tif", "hills_seed": 1)"),
              HasSubstr("hills_seed: a second terrain"));
  EXPECT_EQ(terrain(R"(, "hills_seed": 1, "hills_releif_m": 3)"),
            "farm.geojson:2: features.0.properties.hills_releif_m: unknown key; did you mean "
            "'hills_relief_m'? [E103]");
  EXPECT_THAT(terrain(R"(, "hills_seed": 1, "cell_m": 0)"), HasSubstr("cell_m: 0 is out of range"));
  EXPECT_THAT(terrain(R"(, "path": "a.tif", "cell_m": 1)"), HasSubstr("cell_m: unknown key"));
  const auto hills = feature(R"("kind": "terrain", "hills_seed": 1)", "null");
  EXPECT_THAT(error_of({hills, hills}),
              StartsWith("farm.geojson:3: features.1.properties.hills_seed"));
  EXPECT_EQ(error_of({feature(R"("kind": "soil", "class": "tiled")", square(0, 0, 9))}),
            "farm.geojson:2: features.0.properties.class: 'tiled' is not a known name; did you "
            "mean 'tilled'? [E108]");
  EXPECT_THAT(error_of({feature(R"("kind": "soil")", square(0, 0, 9))}),
              HasSubstr("properties.class: required key is missing"));
  EXPECT_THAT(error_of({feature(R"("kind": "soil", "class": "sand")", point({0, 0}))}),
              HasSubstr("features.0.geometry.type: 'Point' is not the geometry of this kind"));
}

TEST(FarmIoErrors, MissingAndWrongGeometry) {
  EXPECT_THAT(error_of({feature(kParcelKeys, "null")}),
              StartsWith("farm.geojson:2: features.0.geometry: required key is missing; a Polygon "
                         "or MultiPolygon [E104]"));
  EXPECT_THAT(error_of({feature(kParcelKeys, point({0, 0}))}),
              HasSubstr("features.0.geometry.type: 'Point' is not the geometry of this kind; "
                        "allowed: Polygon, MultiPolygon"));
  EXPECT_THAT(error_of({feature(kParcelKeys, R"({"type": "Polygon"})")}),
              HasSubstr("features.0.geometry.coordinates: required key is missing"));
  for (const char* rings : {"[]", "3", "[[]]", "[3]", "[[1, 2]]", "[[[3, 42]]]", "[[[\"a\", 42]]]",
                            "[[[3, 42], [3, 42.001], [3, 42.002]]]", "[[null]]"}) {
    EXPECT_THAT(
        error_of({feature(kParcelKeys,
                          std::string(R"({"type": "Polygon", "coordinates": )") + rings + "}")}),
        StartsWith("farm.geojson:2: features.0.geometry: "))
        << rings;
  }
  EXPECT_THAT(error_of({feature(R"("kind": "road")", line({{0, 0}, {0, 0}}))}),
              HasSubstr("the line has no length"));
  EXPECT_THAT(
      error_of({feature(R"("kind": "gate")", R"({"type": "Point", "coordinates": [42, 3]})")}),
      HasSubstr("km from the farm's origin"));
  EXPECT_THAT(
      error_of({feature(R"("kind": "gate")", R"({"type": "Point", "coordinates": [3, 91]})")}),
      HasSubstr("[3, 91] is out of range"));
}

TEST(FarmIoErrors, ASelfCrossingParcelNamesThePlace) {
  const std::string error =
      error_of({feature(kParcelKeys, polygon({{0, 0}, {40, 40}, {40, 0}, {0, 40}}))});
  EXPECT_THAT(error, StartsWith("farm.geojson:2: features.0.geometry: the boundary crosses or "
                                "touches itself at (20.000, 20.000) m"));
}

TEST(FarmIoErrors, RowsOutsideTheirParcelAreNamedBeyondHalfAMetre) {
  const auto with_row = [](const Polyline& row) {
    return error_of({feature(R"("kind": "row_parcel", "id": "p1")", square(0, 0, 50)),
                     feature(R"("kind": "row", "id": "a", "parcel": "p1")", line(row))});
  };
  EXPECT_EQ(with_row({{0, 0}, {0, 50}}), "no error");
  EXPECT_EQ(with_row({{10, -0.4}, {10, 50.4}}), "no error");
  EXPECT_THAT(with_row({{10, 10}, {10, 52}}),
              StartsWith("farm.geojson:3: features.1.geometry: row 'a' leaves its parcel 'p1' at "
                         "(10.0, 5"));
  EXPECT_THAT(with_row({{10, 10}, {60, 20}, {10, 30}}), HasSubstr("leaves its parcel"));
  EXPECT_THAT(with_row({{100, 100}, {100, 120}}), HasSubstr("leaves its parcel"));
}

TEST(FarmIoErrors, DuplicateIdsNameTheFirst) {
  const std::string error =
      error_of({feature(R"("kind": "free_parcel", "id": "yard")", square(0, 0, 50)),
                feature(R"("kind": "poi", "id": "yard", "role": "dock")", point({0, 0}))});
  EXPECT_THAT(error, StartsWith("farm.geojson:3: features.1.properties.id: the id 'yard' is taken; "
                                "by "));
  EXPECT_THAT(error, HasSubstr("farm.geojson:2"));
  const std::string row =
      feature(R"("kind": "row", "id": "a", "parcel": "p1")", line({{10, 10}, {10, 40}}));
  EXPECT_THAT(
      error_of({feature(R"("kind": "row_parcel", "id": "p1")", square(0, 0, 50)), row, row}),
      StartsWith("farm.geojson:4: features.2.properties.id: parcel 'p1' has a row 'a'"));
}

TEST(FarmIoErrors, ARowOfAnUnknownParcel) {
  EXPECT_THAT(
      error_of({feature(kParcelKeys, square(0, 0, 50)),
                feature(R"("kind": "row", "parcel": "elsewhere")", line({{1, 1}, {1, 9}}))}),
      StartsWith("farm.geojson:3: features.1.properties.parcel: 'elsewhere' is not the id "
                 "of a row_parcel; allowed: p1"));
  EXPECT_THAT(error_of({feature(R"("kind": "row", "parcel": "p1")", line({{1, 1}, {1, 9}}))}),
              HasSubstr("'p1' is not the id of a row_parcel"));
}

// Whatever happens to a file on its way, loading it gives a farm or an error, and never crashes.
TEST(FarmIoErrors, DamagedFilesNeverCrash) {
  const std::string whole = collection({
      feature(kParcelKeys + R"(, "name": "A", "headland_width_m": 2, "headland_outside_m": 2)",
              polygon({{0, 0}, {90, 10}, {80, 70}, {10, 80}})),
      feature(R"("kind": "row", "parcel": "p1")", line({{30, 25}, {30, 60}})),
      feature(R"("kind": "road", "width_m": 5)", line({{-20, 10}, {-5, 15}, {0, 10}})),
      feature(R"("kind": "poi", "id": "w", "role": "dock", "heading_deg": 33)", point({-40, 1})),
  });
  RandomStream random(11, "damage");
  int loaded = 0;
  for (int i = 0; i < 1500; ++i) {
    std::string text = whole;
    for (int k = random.index(3); k >= 0; --k) {
      const auto at = static_cast<std::size_t>(random.index(static_cast<int>(text.size())));
      const auto from = static_cast<std::size_t>(random.index(static_cast<int>(whole.size())));
      const auto count = static_cast<std::size_t>(random.index(12));
      switch (random.index(4)) {
        case 0:
          text.erase(at, count);
          break;
        case 1:
          text.insert(at, whole.substr(from, count));
          break;
        case 2:
          text[at] = static_cast<char>('0' + random.index(10));
          break;
        default:
          text[at] = static_cast<char>(random.index(256));
      }
      if (text.empty()) break;
    }
    const auto farm = load_texts({text});
    if (!farm) {
      EXPECT_LT(to_string(farm.error()).find("farm.geojson"), 1u);
      continue;
    }
    ++loaded;
    drivable_area(*farm);
  }
  EXPECT_GT(loaded, 50);
}

}  // namespace
}  // namespace headland
