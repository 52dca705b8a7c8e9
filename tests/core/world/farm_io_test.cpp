// SPDX-License-Identifier: Apache-2.0
#include "core/world/farm_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/farm_texts.hpp"

namespace headland {
namespace {

using namespace test;
using ::testing::HasSubstr;
using ::testing::StartsWith;

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

}  // namespace
}  // namespace headland
