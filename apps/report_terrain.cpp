// SPDX-License-Identifier: Apache-2.0
#include "apps/report_terrain.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

namespace headland {
namespace {

constexpr double kSteps = 65534.0;
constexpr std::uint16_t kNone = 65535;

}  // namespace

ReportTerrain terrain_raster(const Ground& ground, const MapBox& extent) {
  ReportTerrain raster;
  if (extent.isEmpty()) return raster;
  const Point2 size = extent.sizes();
  const double finest = ground.terrain() != nullptr ? ground.terrain()->cell() : 1.0;
  raster.cell_m = std::max(size.maxCoeff() / (kMostTerrainPoints - 1), finest);
  raster.south_west = extent.min();
  raster.columns = static_cast<int>(size.x() / raster.cell_m) + 1;
  raster.rows = static_cast<int>(size.y() / raster.cell_m) + 1;
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      const auto sample = ground.sample(raster.south_west + raster.cell_m * Point2(column, row));
      raster.heights_m.push_back(sample ? sample->height
                                        : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return raster;
}

PackedHeights pack(const std::vector<double>& heights_m) {
  PackedHeights packed;
  bool first = true;
  for (const double height : heights_m) {
    if (!std::isfinite(height)) continue;
    packed.low_m = first ? height : std::min(packed.low_m, height);
    packed.high_m = first ? height : std::max(packed.high_m, height);
    first = false;
  }
  const double range = packed.high_m - packed.low_m;
  std::vector<unsigned char> bytes;
  for (const double height : heights_m) {
    const double step = range > 0.0 ? kSteps / range * (height - packed.low_m) : 0.0;
    const auto value =
        std::isfinite(height) ? static_cast<std::uint16_t>(std::lround(step)) : kNone;
    bytes.push_back(static_cast<unsigned char>(value % 256));
    bytes.push_back(static_cast<unsigned char>(value / 256));
  }
  packed.base64 = base64(bytes);
  return packed;
}

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return text;
}

}  // namespace headland
