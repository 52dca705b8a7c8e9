// SPDX-License-Identifier: Apache-2.0
// What is wrong with a farm file is said with its place and a remedy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "core/world/farm_io.hpp"
#include "tests/support/farm_texts.hpp"

namespace headland {
namespace {

using namespace test;
using ::testing::HasSubstr;
using ::testing::StartsWith;

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
