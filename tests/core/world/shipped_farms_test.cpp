// SPDX-License-Identifier: Apache-2.0
// Every file in config/farms loads, and shows what its source says of it.
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "core/geometry/region.hpp"
#include "core/world/farm_io.hpp"

namespace headland {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = HEADLAND_SOURCE_DIR;

fs::path data_folder() {
  const char* given = std::getenv("HEADLAND_DATA");
  return given != nullptr ? fs::path(given) : kRoot.parent_path() / "shared" / "data";
}

Farm shipped(const std::string& name) {
  auto farm = load_farm({kRoot / "config" / "farms" / name});
  if (!farm) throw std::runtime_error(to_string(farm.error()));
  return std::move(*farm);
}

double row_metres(const RowParcel& parcel) {
  double sum = 0.0;
  for (const Row& row : parcel.rows) sum += length(row.line);
  return sum;
}

// A robot the size of a small tractor stands at every POI and charger, and can reach every parcel.
void expect_connected(const Farm& farm) {
  const Region region(drivable_area(farm));
  const Footprint footprint{2.0, 0.5, 1.2};
  for (const Poi& poi : farm.pois) EXPECT_TRUE(region.contains(poi.pose, footprint)) << poi.id;
  for (const Charger& c : farm.chargers) EXPECT_TRUE(region.contains(c.pose, footprint)) << c.id;
  EXPECT_EQ(region.polygons().size(), 1u);
}

TEST(ShippedFarms, AllLoad) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(kRoot / "config" / "farms")) {
    if (entry.path().extension() != ".geojson") continue;
    const auto farm = load_farm({entry.path()});
    EXPECT_TRUE(farm) << to_string(farm.error());
    if (!farm) continue;
    ++count;
    const auto again = to_geojson(*farm);
    EXPECT_NE(again.find("FeatureCollection"), std::string::npos);
  }
  EXPECT_GE(count, 5);
}

TEST(ShippedFarms, TheExampleOfTheDocumentLoads) {
  std::ifstream stream(kRoot / "docs" / "farm_map.md");
  std::stringstream document;
  document << stream.rdbuf();
  const std::string text = document.str();
  const std::size_t begin = text.find("```json\n");
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = text.find("```", begin + 8);
  const fs::path file = fs::path(::testing::TempDir()) / "headland_farm_map_example.geojson";
  std::ofstream(file) << text.substr(begin + 8, end - begin - 8);
  const auto farm = load_farm({file});
  fs::remove(file);
  ASSERT_TRUE(farm) << to_string(farm.error());
  EXPECT_EQ(farm->name, "Home farm");
  EXPECT_GT(farm->row_parcels.at(0).rows.size(), 10u);
  expect_connected(*farm);
}

// (000) Sec. IV: row width 3.8 m, row length 130 m, 3.8 ha at 42.1628, 3.0930.
TEST(ShippedFarms, GironaHasTheOrchardsMeasures) {
  const Farm farm = shipped("girona_orchard.geojson");
  const RowParcel* orchard = farm.find_parcel("orchard");
  ASSERT_NE(orchard, nullptr);
  EXPECT_NEAR(area(orchard->boundary), 38000.0, 100.0);
  EXPECT_EQ(orchard->rows.size(), 68u);
  for (const Row& row : orchard->rows) EXPECT_NEAR(length(row.line), 130.0, 0.01);
  EXPECT_EQ(orchard->row_spacing_m, 3.8);
  EXPECT_NEAR(farm.frame.origin().lat_deg, 42.1628, 1e-9);
  EXPECT_NE(farm.find_poi("warehouse"), nullptr);
  EXPECT_NE(farm.find_poi("dock"), nullptr);
  ASSERT_EQ(farm.chargers.size(), 1u);
  EXPECT_EQ(farm.chargers[0].curve.max_power(), 22000.0);
  expect_connected(farm);
}

// (000) Sec. IV: row width 2.5 m, row length 65 m, 0.5 ha at 37.9437, 22.7720.
TEST(ShippedFarms, KiatoHasTheVineyardsMeasures) {
  const Farm farm = shipped("kiato_vineyard.geojson");
  const RowParcel* vineyard = farm.find_parcel("vineyard");
  ASSERT_NE(vineyard, nullptr);
  EXPECT_NEAR(area(vineyard->boundary), 5000.0, 10.0);
  EXPECT_EQ(vineyard->rows.size(), 26u);
  for (const Row& row : vineyard->rows) EXPECT_NEAR(length(row.line), 65.0, 0.01);
  EXPECT_EQ(farm.chargers.size(), 1u);
  expect_connected(farm);
}

// (002): x_i = W / 2 + W (i - 1), y = 0 and 20, depot at (-3 W, 10).
TEST(ShippedFarms, Ebs221HasItsNodes) {
  const Farm farm = shipped("ebs221_field.geojson");
  const RowParcel* field = farm.find_parcel("field");
  ASSERT_NE(field, nullptr);
  ASSERT_EQ(field->rows.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    const Row& row = field->rows[i];
    const double x = 1.25 + 2.5 * static_cast<double>(i);
    EXPECT_EQ(row.id, "r" + std::to_string(i + 1));
    EXPECT_LT((row.line.front() - Point2(x, 0)).norm(), 1e-5);
    EXPECT_LT((row.line.back() - Point2(x, 20)).norm(), 1e-5);
  }
  ASSERT_NE(farm.find_poi("depot"), nullptr);
  EXPECT_LT((farm.find_poi("depot")->pose.position() - Point2(-7.5, 10)).norm(), 1e-5);
  EXPECT_EQ(farm.find_poi("depot")->pose.yaw, 0.0);
  expect_connected(farm);
}

// (004) Fig. 4: rows at x = 5, 15, ..., 95 from y = 10 to 90, trees between, 100 x 100 m.
TEST(ShippedFarms, PolitoHasTheOrchardOfFigure4) {
  const Farm farm = shipped("polito_orchard.geojson");
  const RowParcel* orchard = farm.find_parcel("orchard");
  ASSERT_NE(orchard, nullptr);
  ASSERT_EQ(orchard->rows.size(), 10u);
  EXPECT_NEAR(row_metres(*orchard), 800.0, 1e-3);
  EXPECT_EQ(farm.keep_outs.size(), 9u);
  for (const KeepOut& trees : farm.keep_outs) EXPECT_NEAR(area(trees.boundary), 160.0, 1e-3);
  EXPECT_LT((farm.find_poi("start")->pose.position() - Point2(5, 0)).norm(), 1e-5);
  EXPECT_LT((farm.find_poi("goal")->pose.position() - Point2(95, 0)).norm(), 1e-5);
  expect_connected(farm);
}

// shared/data/README.md: 10 blocks, 92 rows, 9 037 m (here 9 047 m: on the ellipsoid), 2.40 m
// apart.
TEST(ShippedFarms, TheRealVineyardLoadsWithItsOverlay) {
  const fs::path vineyard = data_folder() / "farms" / "jojos_vineyard" / "jojos_vineyard.geojson";
  if (!fs::exists(vineyard)) GTEST_SKIP() << "no " << vineyard << "; set HEADLAND_DATA";
  const auto farm =
      load_farm({vineyard, kRoot / "config" / "farms" / "jojos_vineyard_overlay.geojson"},
                {.headland_outside_m = 8.0});
  ASSERT_TRUE(farm) << to_string(farm.error());
  EXPECT_EQ(farm->row_parcels.size(), 10u);
  std::size_t rows = 0;
  double metres = 0.0;
  std::set<std::string> ids;
  for (const RowParcel& parcel : farm->row_parcels) {
    rows += parcel.rows.size();
    metres += row_metres(parcel);
    EXPECT_NEAR(parcel.row_spacing_m, 2.40, 0.005) << parcel.id;
    EXPECT_EQ(parcel.headland_outside_m, 8.0);
    for (const Row& row : parcel.rows) ids.insert(row.id);
  }
  EXPECT_EQ(rows, 92u);
  EXPECT_EQ(ids.size(), 92u);
  EXPECT_NEAR(metres, 9037.0, 15.0);
  EXPECT_EQ(farm->gates.size(), 3u);
  EXPECT_EQ(farm->chargers.size(), 2u);
  EXPECT_NE(farm->find_poi("dock"), nullptr);

  // Dock, chargers, gates and all parcels lie in one connected area.
  const auto area_list = drivable_area(*farm);
  const auto part_of = [&](const Point2& p) {
    const auto at = std::find_if(area_list.begin(), area_list.end(),
                                 [&](const Polygon& one) { return contains(one, p); });
    return at - area_list.begin();
  };
  const auto dock = part_of(farm->find_poi("dock")->pose.position());
  ASSERT_LT(dock, static_cast<std::ptrdiff_t>(area_list.size()));
  for (const Charger& c : farm->chargers) EXPECT_EQ(part_of(c.pose.position()), dock) << c.id;
  for (const Gate& g : farm->gates) EXPECT_EQ(part_of(g.position), dock) << g.id;
  for (const RowParcel& p : farm->row_parcels) {
    EXPECT_EQ(part_of(p.rows[0].line[0]), dock) << p.id;
  }
}

}  // namespace
}  // namespace headland
