// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>

#include <fmt/format.h>
#include <gdal.h>
#include <gdal_frmts.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_srs_api.h>

#include "core/world/terrain.hpp"

namespace headland {
namespace {

using ::testing::HasSubstr;

const LocalFrame kFrame(LatLon{42.1628, 3.0930});

struct Spec {
  int epsg = 32631;                    // 0: none
  Point2 corner{507200.0, 4668300.0};  // upper left, in that system
  double pixel = 5.0;
  int columns = 200;
  int rows = 160;
  GDALDataType type = GDT_Float32;
  std::string unit{};
  bool points = false;  // AREA_OR_POINT=Point
};

// East and north of a place in a system, to write and to check with.
class System {
 public:
  explicit System(int epsg) {
    OGRSpatialReferenceH from = OSRNewSpatialReference(nullptr);
    OGRSpatialReferenceH to = OSRNewSpatialReference(nullptr);
    OSRImportFromEPSG(from, 4326);
    OSRImportFromEPSG(to, epsg);
    OSRSetAxisMappingStrategy(from, OAMS_TRADITIONAL_GIS_ORDER);
    OSRSetAxisMappingStrategy(to, OAMS_TRADITIONAL_GIS_ORDER);
    transformation_ = OCTNewCoordinateTransformation(from, to);
    OSRDestroySpatialReference(from);
    OSRDestroySpatialReference(to);
  }
  ~System() { OCTDestroyCoordinateTransformation(transformation_); }
  System(const System&) = delete;
  System& operator=(const System&) = delete;
  Point2 of(const Point2& p_map) const {
    const LatLon at = kFrame.to_wgs84(p_map);
    Point2 p(at.lon_deg, at.lat_deg);
    OCTTransform(transformation_, 1, &p.x(), &p.y(), nullptr);
    return p;
  }

 private:
  OGRCoordinateTransformationH transformation_;
};

std::filesystem::path temporary(const std::string& name) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(::testing::TempDir()) / "headland_geotiff";
  std::filesystem::create_directories(folder);
  return folder / (std::string(test->name()) + "_" + name);
}

// Writes heights by the coordinates of the pixels' centres.
std::filesystem::path write(const Spec& spec, const std::function<double(Point2)>& height,
                            std::optional<double> no_data = {}) {
  const auto file = temporary(fmt::format("{}.tif", spec.epsg));
  GDALRegister_GTiff();
  GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("GTiff"), file.c_str(), spec.columns,
                                    spec.rows, 1, spec.type, nullptr);
  double transform[6] = {spec.corner.x(), spec.pixel, 0.0, spec.corner.y(), 0.0, -spec.pixel};
  GDALSetGeoTransform(dataset, transform);
  if (spec.epsg != 0) {
    OGRSpatialReferenceH system = OSRNewSpatialReference(nullptr);
    OSRImportFromEPSG(system, spec.epsg);
    GDALSetSpatialRef(dataset, system);
    OSRDestroySpatialReference(system);
  }
  if (spec.points) GDALSetMetadataItem(dataset, "AREA_OR_POINT", "Point", nullptr);
  GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
  if (!spec.unit.empty()) GDALSetRasterUnitType(band, spec.unit.c_str());
  if (no_data) GDALSetRasterNoDataValue(band, *no_data);
  std::vector<double> line(static_cast<std::size_t>(spec.columns));
  for (int row = 0; row < spec.rows; ++row) {
    for (int column = 0; column < spec.columns; ++column) {
      line[static_cast<std::size_t>(column)] =
          height(spec.corner + spec.pixel * Point2(column + 0.5, -row - 0.5));
    }
    EXPECT_EQ(GDALRasterIO(band, GF_Write, 0, row, spec.columns, 1, line.data(), spec.columns, 1,
                           GDT_Float64, 0, 0),
              CE_None);
  }
  GDALClose(dataset);
  return file;
}

// A slope in the file's own coordinates must come out as that slope at the same places.
void expect_exact(const Spec& spec, const Point2& slope_per_unit, double tolerance) {
  const System system(spec.epsg);
  const Point2 origin = spec.corner;
  const auto height = [&](const Point2& p) { return 100.0 + slope_per_unit.dot(p - origin); };
  const auto terrain = load_terrain(write(spec, height), kFrame);
  ASSERT_TRUE(terrain) << to_string(terrain.error());
  for (double x = -200.0; x <= 200.0; x += 23.0) {
    for (double y = -200.0; y <= 200.0; y += 23.0) {
      const auto found = terrain->at({x, y});
      ASSERT_TRUE(found) << to_string(found.error());
      EXPECT_NEAR(found->height, height(system.of({x, y})), tolerance);
      constexpr double kStep = 0.5;
      const Point2 expected(height(system.of({x + kStep, y})) - height(system.of({x - kStep, y})),
                            height(system.of({x, y + kStep})) - height(system.of({x, y - kStep})));
      EXPECT_LT((found->gradient - expected / (2 * kStep)).norm(), 1e-4);
    }
  }
}

TEST(GeoTiff, UtmLandsWhereItLies) { expect_exact({}, {0.05, -0.03}, 1e-4); }

TEST(GeoTiff, DegreesLandWhereTheyLie) {
  // 1 arc second: 31 m to the north, 23 m to the east.
  Spec spec{4326, {3.0885, 42.1672}, 1.0 / 3600.0, 40, 40};
  expect_exact(spec, {4000.0, -3000.0}, 1e-3);
  const auto terrain = load_terrain(temporary("4326.tif"), kFrame);
  EXPECT_NEAR(terrain->cell(), 22.9, 0.2);
}

TEST(GeoTiff, LambertOfAllEuropeLandsWhereItLies) {
  const Point2 here = System(3035).of({0.0, 0.0});
  expect_exact({3035, here + Point2(-500.0, 500.0), 5.0, 200, 200}, {0.02, 0.04}, 1e-3);
}

TEST(GeoTiff, MercatorOfTheWebLandsWhereItLies) {
  const Point2 here = System(3857).of({0.0, 0.0});
  const Spec spec{3857, here + Point2(-600.0, 600.0), 2.0, 600, 600};
  expect_exact(spec, {0.05, -0.02}, 1e-4);
  // Its metres are too long by 1 / cos(latitude).
  EXPECT_NEAR(load_terrain(temporary("3857.tif"), kFrame)->cell(), 2.0 * std::cos(0.7359), 0.01);
}

TEST(GeoTiff, WholeNumbersAndFeet) {
  Spec spec;
  spec.type = GDT_Int16;
  auto terrain = load_terrain(write(spec, [](const Point2&) { return 250.0; }), kFrame);
  ASSERT_TRUE(terrain) << to_string(terrain.error());
  EXPECT_EQ(terrain->at({0.0, 0.0})->height, 250.0);
  spec.unit = "ft";
  terrain = load_terrain(write(spec, [](const Point2&) { return 250.0; }), kFrame);
  ASSERT_TRUE(terrain) << to_string(terrain.error());
  EXPECT_NEAR(terrain->at({0.0, 0.0})->height, 76.2, 1e-5);
  spec.unit = "furlong";
  terrain = load_terrain(write(spec, [](const Point2&) { return 250.0; }), kFrame);
  ASSERT_FALSE(terrain);
  EXPECT_THAT(to_string(terrain.error()), HasSubstr("heights in 'furlong'; metres or feet [E110]"));
}

TEST(GeoTiff, PixelsMarkedAsPointsAreNotShiftedTwice) {
  // GDAL moves the corner by half a pixel on writing and back on reading.
  Spec spec;
  spec.points = true;
  expect_exact(spec, {0.05, -0.03}, 1e-4);
}

TEST(GeoTiff, NoDataHasNoHeight) {
  const Point2 here = System(32631).of({0.0, 0.0});
  const auto hole = [&here](const Point2& p) { return (p - here).norm() < 30.0; };
  for (const double mark : {-9999.0, -3.4e38, 32767.0}) {
    for (const bool declared : {true, false}) {
      const auto file = write(
          {}, [&](const Point2& p) { return hole(p) ? mark : 55.0; },
          declared ? std::optional<double>(mark) : std::nullopt);
      const auto terrain = load_terrain(file, kFrame);
      ASSERT_TRUE(terrain) << to_string(terrain.error());
      EXPECT_FALSE(terrain->at({0.0, 0.0})) << mark;
      EXPECT_EQ(terrain->at({60.0, 0.0})->height, 55.0);
    }
  }
  const auto nothing = load_terrain(write(
                                        {}, [](const Point2&) { return -9999.0; }, -9999),
                                    kFrame);
  ASSERT_FALSE(nothing);
  EXPECT_THAT(to_string(nothing.error()), HasSubstr("the raster has no data here [E102]"));
}

TEST(GeoTiff, OnlyThePartAroundTheExtentIsKept) {
  const auto file = write({}, [](const Point2& p) { return p.x() - 507200.0; });
  const MapBox extent(Point2(-40.0, -30.0), Point2(60.0, 50.0));
  const auto all = load_terrain(file, kFrame);
  const auto part = load_terrain(file, kFrame, extent);
  ASSERT_TRUE(part) << to_string(part.error());
  for (const Point2& p : {extent.min(), extent.max(), Point2(-40.0, 50.0), Point2(0.0, 0.0)}) {
    ASSERT_TRUE(part->at(p));
    EXPECT_NEAR(part->at(p)->height, all->at(p)->height, 1e-5);
  }
  EXPECT_TRUE(all->at({100.0, 0.0}));
  EXPECT_FALSE(part->at({100.0, 0.0}));
}

TEST(GeoTiff, AnExtentThatReachesOutOfTheFileKeepsWhatThereIs) {
  const auto file = write({}, [](const Point2&) { return 5.0; });
  const auto part = load_terrain(file, kFrame, MapBox(Point2(-100.0, -100.0), Point2(1e4, 1e4)));
  ASSERT_TRUE(part) << to_string(part.error());
  EXPECT_TRUE(part->at({0.0, 0.0}));
  EXPECT_FALSE(part->at({5000.0, 0.0}));
  const auto none = load_terrain(file, kFrame, MapBox(Point2(5000.0, 0.0), Point2(6000.0, 9.0)));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kOffTerrain);
  EXPECT_THAT(to_string(none.error()), HasSubstr("the terrain lies somewhere else"));
}

TEST(GeoTiff, WhatIsNoTerrainIsRefused) {
  const auto absent = load_terrain("/no/such/dem.tif", kFrame);
  ASSERT_FALSE(absent);
  EXPECT_EQ(to_string(absent.error()), "/no/such/dem.tif: no such file; check the path [E101]");
  const auto text = load_terrain(HEADLAND_SOURCE_DIR "/README.md", kFrame);
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, ErrorCode::kSyntax);
  EXPECT_THAT(text.error().what, HasSubstr("not a GeoTIFF"));
  Spec nowhere;
  nowhere.epsg = 0;
  const auto lost = load_terrain(write(nowhere, [](const Point2&) { return 1.0; }), kFrame);
  ASSERT_FALSE(lost);
  EXPECT_THAT(lost.error().what, HasSubstr("no coordinate system"));
  EXPECT_THAT(lost.error().where.file, HasSubstr(".tif"));
}

TEST(GeoTiff, AGridTooWideForTheFitIsRefusedAndItsPartIsNot) {
  // Half of Europe in pixels of 1 km.
  const Spec spec{3035, {3000000.0, 3200000.0}, 1000.0, 1500, 1500};
  const auto file = write(spec, [](const Point2&) { return 7.0; });
  const auto whole = load_terrain(file, kFrame);
  ASSERT_FALSE(whole);
  EXPECT_EQ(whole.error().code, ErrorCode::kUnsupported);
  const auto part =
      load_terrain(file, kFrame, MapBox(Point2(-900.0, -900.0), Point2(900.0, 900.0)));
  ASSERT_TRUE(part) << to_string(part.error());
  EXPECT_EQ(part->at({0.0, 0.0})->height, 7.0);
}

TEST(GeoTiff, APublicValleyIsRead) {
  const char* data = std::getenv("HEADLAND_DATA");
  const auto file = std::filesystem::path(data != nullptr ? data : "../shared/data") /
                    "farms/dem/elev_vinschgau.tif";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  // Schlanders, on the floor of the valley at 720 m; the grid's cells are 250 m wide.
  const LocalFrame schlanders(LatLon{46.6277, 10.7722});
  const auto terrain = load_terrain(file, schlanders);
  ASSERT_TRUE(terrain) << to_string(terrain.error());
  EXPECT_NEAR(terrain->cell(), 250.0, 0.2);
  EXPECT_NEAR(terrain->at({0.0, 0.0})->height, 720.0, 100.0);
  EXPECT_GT(terrain->at({0.0, 6000.0})->height, 1500.0);
  // The Ortler, 3905 m, and steep.
  EXPECT_NEAR(terrain->at(schlanders.to_map({46.5089, 10.5447}))->height, 3700.0, 170.0);
}

}  // namespace
}  // namespace headland
