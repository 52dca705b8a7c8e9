// SPDX-License-Identifier: Apache-2.0
#include "core/world/internal/geotiff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal.h>
#include <gdal_frmts.h>
#include <ogr_srs_api.h>

namespace headland::internal {
namespace {

constexpr int kTies = 17;            // along either side of the part that is read
constexpr int kBorder = 2;           // pixels read beyond the extent
constexpr double kMostPixels = 4e8;  // 1.6 GB of heights
// What no place on Earth has: a mark for "no data" that the file does not declare.
constexpr double kLowest = -1000.0;
constexpr double kHighest = 9500.0;

// GDAL speaks through a handler of the process; while this lives it keeps quiet.
class Quiet {
 public:
  Quiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~Quiet() { CPLPopErrorHandler(); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
};

struct CloseDataset {
  void operator()(void* dataset) const { GDALClose(dataset); }
};
struct DestroyTransformation {
  void operator()(void* transformation) const {
    OCTDestroyCoordinateTransformation(static_cast<OGRCoordinateTransformationH>(transformation));
  }
};
struct DestroySystem {
  void operator()(void* system) const { OSRDestroySpatialReference(system); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;
using System = std::unique_ptr<void, DestroySystem>;

// The handle is a pointer to an opaque type, unlike those above.
using Transformation =
    std::unique_ptr<std::remove_pointer_t<OGRCoordinateTransformationH>, DestroyTransformation>;

// Pixels of the whole file <-> map. A pixel's centre has whole numbers.
class Georeference {
 public:
  static std::optional<Georeference> of(GDALDatasetH dataset, const LocalFrame& frame) {
    Georeference made;
    const char* wkt = GDALGetProjectionRef(dataset);
    if (wkt == nullptr || *wkt == '\0' ||
        GDALGetGeoTransform(dataset, made.to_system_.data()) != CE_None ||
        !GDALInvGeoTransform(made.to_system_.data(), made.to_pixel_.data())) {
      return std::nullopt;
    }
    const System system(OSRNewSpatialReference(wkt));
    const System wgs84(OSRNewSpatialReference(nullptr));
    if (!system || OSRSetWellKnownGeogCS(wgs84.get(), "WGS84") != OGRERR_NONE) return std::nullopt;
    OSRStripVertical(system.get());  // heights stay what they are
    for (const System* s : {&system, &wgs84}) {
      OSRSetAxisMappingStrategy(s->get(), OAMS_TRADITIONAL_GIS_ORDER);  // east before north
    }
    made.frame_ = frame;
    made.from_wgs84_.reset(OCTNewCoordinateTransformation(wgs84.get(), system.get()));
    made.to_wgs84_.reset(OCTNewCoordinateTransformation(system.get(), wgs84.get()));
    if (!made.from_wgs84_ || !made.to_wgs84_) return std::nullopt;
    return made;
  }

  std::optional<Point2> pixel(const Point2& p_map) const {
    const LatLon at = frame_.to_wgs84(p_map);
    Point2 p(at.lon_deg, at.lat_deg);
    if (!OCTTransform(from_wgs84_.get(), 1, &p.x(), &p.y(), nullptr)) return std::nullopt;
    Point2 corner_based;
    GDALApplyGeoTransform(to_pixel_.data(), p.x(), p.y(), &corner_based.x(), &corner_based.y());
    return corner_based - Point2(0.5, 0.5);
  }
  std::optional<Point2> map(const Point2& pixel) const {
    Point2 p;
    GDALApplyGeoTransform(to_system_.data(), pixel.x() + 0.5, pixel.y() + 0.5, &p.x(), &p.y());
    if (!OCTTransform(to_wgs84_.get(), 1, &p.x(), &p.y(), nullptr)) return std::nullopt;
    return frame_.to_map({p.y(), p.x()});
  }

 private:
  Georeference() = default;

  LocalFrame frame_;
  mutable std::array<double, 6> to_system_{};  // GDAL's C functions take them without const
  mutable std::array<double, 6> to_pixel_{};
  Transformation from_wgs84_;
  Transformation to_wgs84_;
};

struct Window {
  int column = 0;
  int row = 0;
  int columns = 0;
  int rows = 0;
};

// Pixels around the extent: those of a net over it, and a border.
std::optional<Window> window_around(const Georeference& georeference, const MapBox& extent,
                                    const Window& all) {
  MapBox pixels;
  for (int i = 0; i < kTies; ++i) {
    for (int k = 0; k < kTies; ++k) {
      const Point2 fraction(i / (kTies - 1.0), k / (kTies - 1.0));
      const auto p = georeference.pixel(extent.min() + extent.sizes().cwiseProduct(fraction));
      if (p && p->allFinite()) pixels.extend(*p);
    }
  }
  const MapBox whole(Point2(0.0, 0.0), Point2(all.columns - 1.0, all.rows - 1.0));
  if (pixels.isEmpty() || !whole.intersects(pixels)) return std::nullopt;
  const Point2 border(kBorder, kBorder);
  const MapBox part = whole.intersection(MapBox(pixels.min() - border, pixels.max() + border));
  const auto first = part.min().array().floor().cast<int>().eval();
  const auto last = part.max().array().ceil().cast<int>().eval();
  return Window{first.x(), first.y(), last.x() - first.x() + 1, last.y() - first.y() + 1};
}

// Metres in the band's unit of height; none if it is unknown.
std::optional<double> unit_of(GDALRasterBandH band) {
  static constexpr std::pair<std::string_view, double> kUnits[] = {
      {"", 1.0},      {"m", 1.0},       {"metre", 1.0},
      {"meter", 1.0}, {"metres", 1.0},  {"meters", 1.0},
      {"ft", 0.3048}, {"foot", 0.3048}, {"US survey foot", 1200.0 / 3937.0}};
  const std::string_view unit = GDALGetRasterUnitType(band);
  for (const auto& [name, metres] : kUnits) {
    if (unit == name) return metres;
  }
  return std::nullopt;
}

// The band's heights [m], NaN where its mask says "no data"; empty if reading fails.
std::vector<float> read_heights(GDALRasterBandH band, const Window& w, double unit) {
  const auto size = static_cast<std::size_t>(w.columns) * static_cast<std::size_t>(w.rows);
  std::vector<float> heights(size);
  std::vector<unsigned char> valid(size);
  if (GDALRasterIO(band, GF_Read, w.column, w.row, w.columns, w.rows, heights.data(), w.columns,
                   w.rows, GDT_Float32, 0, 0) != CE_None ||
      GDALRasterIO(GDALGetMaskBand(band), GF_Read, w.column, w.row, w.columns, w.rows, valid.data(),
                   w.columns, w.rows, GDT_Byte, 0, 0) != CE_None) {
    return {};
  }
  const double scale = GDALGetRasterScale(band, nullptr);
  const double offset = GDALGetRasterOffset(band, nullptr);
  for (std::size_t i = 0; i < size; ++i) {
    const double height = (static_cast<double>(heights[i]) * scale + offset) * unit;
    const bool has_data = valid[i] != 0 && height > kLowest && height < kHighest;
    heights[i] = has_data ? static_cast<float>(height) : std::numeric_limits<float>::quiet_NaN();
  }
  return heights;
}

// Where a net of the part's points lies on the map; empty if one has no place there.
std::vector<Raster::Tie> tie(const Georeference& georeference, const Window& w) {
  std::vector<Raster::Tie> ties;
  for (int i = 0; i < kTies; ++i) {
    for (int k = 0; k < kTies; ++k) {
      const Point2 in_grid(i / (kTies - 1.0) * (w.columns - 1), k / (kTies - 1.0) * (w.rows - 1));
      const auto p_map = georeference.map(Point2(w.column, w.row) + in_grid);
      if (!p_map || !p_map->allFinite()) return {};
      ties.push_back({in_grid, *p_map});
    }
  }
  return ties;
}

}  // namespace

Result<Raster> read_geotiff(const std::filesystem::path& file, const LocalFrame& frame,
                            const std::optional<MapBox>& extent) {
  const Location where{file.string(), 0, ""};
  const auto refuse = [&where](ErrorCode code, std::string what, std::string remedy = {}) {
    return fail(code, std::move(what), std::move(remedy), where);
  };
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    return refuse(ErrorCode::kFileNotFound, "no such file", "check the path");
  }
  const Quiet quiet;
  GDALRegister_GTiff();
  const char* const drivers[] = {"GTiff", nullptr};
  const Dataset dataset(
      GDALOpenEx(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, nullptr, nullptr));
  if (!dataset || GDALGetRasterCount(dataset.get()) < 1) {
    return refuse(ErrorCode::kSyntax, fmt::format("not a GeoTIFF ({})", CPLGetLastErrorMsg()));
  }
  const auto georeference = Georeference::of(dataset.get(), frame);
  if (!georeference) {
    return refuse(ErrorCode::kSyntax, "the raster has no coordinate system that can be used",
                  "a GeoTIFF with a coordinate system and a pixel size");
  }
  const Window all{0, 0, GDALGetRasterXSize(dataset.get()), GDALGetRasterYSize(dataset.get())};
  const auto window = extent ? window_around(*georeference, *extent, all) : all;
  if (!window) {
    return refuse(ErrorCode::kOffTerrain, "the terrain lies somewhere else than the farm",
                  "a GeoTIFF that covers the farm");
  }
  if (window->columns < 2 || window->rows < 2 ||
      1.0 * window->columns * window->rows > kMostPixels) {
    return refuse(ErrorCode::kUnsupported,
                  fmt::format("{} x {} pixels of terrain", window->columns, window->rows),
                  "2 x 2 to 400 million pixels");
  }
  GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
  const auto unit = unit_of(band);
  if (!unit) {
    return refuse(ErrorCode::kUnsupported,
                  fmt::format("heights in '{}'", GDALGetRasterUnitType(band)), "metres or feet");
  }
  Raster raster{window->columns, window->rows, read_heights(band, *window, *unit),
                tie(*georeference, *window)};
  if (raster.heights.empty()) {
    return refuse(ErrorCode::kSyntax, fmt::format("cannot be read: {}", CPLGetLastErrorMsg()));
  }
  if (raster.ties.empty()) {
    return refuse(ErrorCode::kSyntax, "the raster's coordinates cannot be taken to WGS84");
  }
  if (std::all_of(raster.heights.begin(), raster.heights.end(),
                  [](float h) { return std::isnan(h); })) {
    return refuse(ErrorCode::kSyntax, "the raster has no data here");
  }
  return raster;
}

}  // namespace headland::internal
