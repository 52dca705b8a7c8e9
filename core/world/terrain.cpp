// SPDX-License-Identifier: Apache-2.0
#include "core/world/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include <Eigen/QR>
#include <fmt/format.h>

#include "core/base/random.hpp"
#include "core/world/internal/geotiff.hpp"

namespace headland {
namespace {

constexpr double kFitTolerance = 1e-3;   // [cells] of the polynomial
constexpr double kEdgeTolerance = 1e-6;  // [cells] beyond the outermost points: rounding
constexpr int kOctaves = 3;              // sizes of hills, each half the one before
constexpr int kDirections = 8;           // waves of each size

using Monomials = std::array<double, 10>;

Monomials monomials(double u, double v) {
  return {1.0, u, v, u * u, u * v, v * v, u * u * u, u * u * v, u * v * v, v * v * v};
}

double value(const std::array<double, 10>& c, double u, double v) {
  return c[0] + u * (c[1] + u * (c[3] + u * c[6] + v * c[7]) + v * (c[4] + v * c[8])) +
         v * (c[2] + v * (c[5] + v * c[9]));
}

Point2 gradient(const std::array<double, 10>& c, double u, double v) {
  return {c[1] + u * (2.0 * c[3] + 3.0 * u * c[6] + 2.0 * v * c[7]) + v * (c[4] + v * c[8]),
          c[2] + v * (2.0 * c[5] + 3.0 * v * c[9] + 2.0 * u * c[8]) + u * (c[4] + u * c[7])};
}

std::string_view bytes_of(const auto& list) {
  const auto bytes = std::as_bytes(std::span(list));
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// A long row of parallel hills.
struct Wave {
  Point2 number;  // wave vector [rad/m]
  double phase = 0.0;
  double amplitude = 0.0;
};

std::vector<Wave> waves(const HillSpec& spec) {
  RandomStream random(spec.seed, "core/hills");
  std::vector<Wave> list;
  for (int octave = 0; octave < kOctaves; ++octave) {
    const double amplitude = std::ldexp(1.0, -octave);
    for (int k = 0; k < kDirections; ++k) {
      const double length = spec.wavelength_m * amplitude * random.uniform(0.7, 1.0);
      const double direction = kPi * (k + random.uniform()) / kDirections;
      const double number = 2.0 * kPi / length;
      list.push_back({{number * std::cos(direction), number * std::sin(direction)},
                      random.uniform(0.0, 2.0 * kPi),
                      amplitude});
    }
  }
  return list;
}

}  // namespace

Terrain Terrain::from_grid(Point2 south_west, double cell, int columns, int rows,
                           std::vector<double> heights) {
  HEADLAND_CHECK(columns >= 2 && rows >= 2 && cell > 0.0, "a terrain needs 2 x 2 points");
  HEADLAND_CHECK(
      heights.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
      "a terrain with more or fewer heights than points");
  Terrain terrain;
  terrain.columns_ = columns;
  terrain.rows_ = rows;
  terrain.cell_ = cell;
  terrain.heights_.assign(heights.begin(), heights.end());
  terrain.center_ = south_west;
  terrain.scale_ = cell;
  terrain.to_column_[1] = 1.0;
  terrain.to_row_[2] = 1.0;
  return terrain;
}

Terrain Terrain::hills(const HillSpec& spec, Point2 south_west, Point2 north_east) {
  const double cell = spec.cell_m;
  const Point2 size = (north_east - south_west) / cell;
  const int columns = std::max(1, static_cast<int>(std::ceil(size.x()))) + 1;
  const int rows = std::max(1, static_cast<int>(std::ceil(size.y()))) + 1;
  // cos(a + b) = cos a cos b - sin a sin b, a of the column and b of the row: few sines for many
  // points.
  const std::vector<Wave> list = waves(spec);
  const auto count = static_cast<Eigen::Index>(list.size());
  Eigen::MatrixXd of_column(columns, 2 * count);
  Eigen::MatrixXd of_row(rows, 2 * count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Wave& wave = list[static_cast<std::size_t>(k)];
    for (int i = 0; i < columns; ++i) {
      const double a = wave.number.x() * (south_west.x() + cell * i);
      of_column(i, 2 * k) = wave.amplitude * std::cos(a);
      of_column(i, 2 * k + 1) = -wave.amplitude * std::sin(a);
    }
    for (int i = 0; i < rows; ++i) {
      const double b = wave.phase + wave.number.y() * (south_west.y() + cell * i);
      of_row(i, 2 * k) = std::cos(b);
      of_row(i, 2 * k + 1) = std::sin(b);
    }
  }
  const Eigen::MatrixXd heights = of_column * of_row.transpose();
  const double lowest = heights.minCoeff();
  const double range = heights.maxCoeff() - lowest;
  std::vector<double> scaled;
  scaled.reserve(static_cast<std::size_t>(heights.size()));
  for (const double h : heights.reshaped()) scaled.push_back((h - lowest) / range * spec.relief_m);
  return from_grid(south_west, cell, columns, rows, std::move(scaled));
}

std::optional<Terrain::Place> Terrain::find(const Point2& p_map) const {
  Place place;
  place.u = (p_map.x() - center_.x()) / scale_;
  place.v = (p_map.y() - center_.y()) / scale_;
  const double column = value(to_column_, place.u, place.v);
  const double row = value(to_row_, place.u, place.v);
  const bool inside = column >= -kEdgeTolerance && column <= columns_ - 1 + kEdgeTolerance &&
                      row >= -kEdgeTolerance && row <= rows_ - 1 + kEdgeTolerance;
  if (!inside) return std::nullopt;  // also for NaN
  const int c = std::clamp(static_cast<int>(column), 0, columns_ - 2);
  const int r = std::clamp(static_cast<int>(row), 0, rows_ - 2);
  const float* corner = heights_.data() + static_cast<std::ptrdiff_t>(r) * columns_ + c;
  const double h00 = corner[0];
  const double h10 = corner[1];
  const double h01 = corner[columns_];
  const double h11 = corner[columns_ + 1];
  const double fc = column - c;
  const double fr = row - r;
  const double low = h00 + fc * (h10 - h00);
  const double high = h01 + fc * (h11 - h01);
  place.height = low + fr * (high - low);
  if (std::isnan(place.height)) return std::nullopt;  // a corner without data
  place.by_column = (1.0 - fr) * (h10 - h00) + fr * (h11 - h01);
  place.by_row = high - low;
  return place;
}

std::optional<double> Terrain::height(const Point2& p_map) const {
  const auto place = find(p_map);
  return place ? std::optional(place->height) : std::nullopt;
}

std::optional<TerrainSample> Terrain::sample(const Point2& p_map) const {
  const auto place = find(p_map);
  if (!place) return std::nullopt;
  const Point2 per_unit = place->by_column * gradient(to_column_, place->u, place->v) +
                          place->by_row * gradient(to_row_, place->u, place->v);
  return TerrainSample{place->height, per_unit / scale_};
}

Result<TerrainSample> Terrain::at(const Point2& p_map) const {
  if (const auto found = sample(p_map)) return *found;
  return fail(ErrorCode::kOffTerrain,
              fmt::format("the terrain has no height at ({:.1f}, {:.1f}) m", p_map.x(), p_map.y()),
              "terrain must cover all that is driven on");
}

std::uint64_t Terrain::fingerprint() const {
  std::uint64_t hash = fnv1a(bytes_of(heights_));
  const std::array<double, 5> shape{1.0 * columns_, 1.0 * rows_, center_.x(), center_.y(), scale_};
  for (const auto part :
       {fnv1a(bytes_of(shape)), fnv1a(bytes_of(to_column_)), fnv1a(bytes_of(to_row_))}) {
    hash = fnv1a(bytes_of(std::array{hash, part}));
  }
  return hash;
}

Result<Terrain> load_terrain(const std::filesystem::path& file, const LocalFrame& frame,
                             const std::optional<MapBox>& extent) {
  auto raster = internal::read_geotiff(file, frame, extent);
  if (!raster) return tl::unexpected<Error>(raster.error());
  Terrain terrain;
  terrain.columns_ = raster->columns;
  terrain.rows_ = raster->rows;
  terrain.heights_ = std::move(raster->heights);
  MapBox box;
  for (const auto& tie : raster->ties) box.extend(tie.p_map);
  terrain.center_ = box.center();
  terrain.scale_ = 0.5 * box.sizes().maxCoeff();

  // Least squares over every other tie; the ones in between are for the check.
  const auto count = static_cast<Eigen::Index>(raster->ties.size());
  Eigen::MatrixXd all(count, 10);
  Eigen::MatrixXd wanted(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& tie = raster->ties[static_cast<std::size_t>(i)];
    const Point2 p = (tie.p_map - terrain.center_) / terrain.scale_;
    const Monomials m = monomials(p.x(), p.y());
    all.row(i) = Eigen::Map<const Eigen::RowVectorXd>(m.data(), 10);
    wanted.row(i) = tie.in_grid.transpose();
  }
  const auto every_other = Eigen::seq(0, count - 1, 2);
  const Eigen::MatrixXd coefficients = all(every_other, Eigen::all)
                                           .eval()
                                           .colPivHouseholderQr()
                                           .solve(wanted(every_other, Eigen::all).eval());
  const double residual = (all * coefficients - wanted).cwiseAbs().maxCoeff();
  if (!(residual < kFitTolerance)) {
    return fail(
        ErrorCode::kUnsupported,
        fmt::format("the terrain's grid is bent too much ({:.4f} cells from a cubic)", residual),
        "cut the file down to the farm's surroundings", {file.string(), 0, ""});
  }
  for (Eigen::Index k = 0; k < 10; ++k) {
    terrain.to_column_[static_cast<std::size_t>(k)] = coefficients(k, 0);
    terrain.to_row_[static_cast<std::size_t>(k)] = coefficients(k, 1);
  }
  const double steepest = std::max(gradient(terrain.to_column_, 0.0, 0.0).norm(),
                                   gradient(terrain.to_row_, 0.0, 0.0).norm());
  terrain.cell_ = terrain.scale_ / steepest;
  return terrain;
}

}  // namespace headland
