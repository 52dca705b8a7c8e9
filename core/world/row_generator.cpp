// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/world/farm_io.hpp"
#include "core/world/internal/row_fit.hpp"

namespace headland {
namespace {

// Farm maps carry some 0.1 m of rounding and hand drawing: a parcel that is short of a whole number
// of rows by this share of the spacing still gets them all.
constexpr double kCountSlack = 0.01;
constexpr double kMostRows = 100000.0;

// Positions along `along` at which the line `offset` to the right of the origin crosses the rings:
// in pairs, entering and leaving.
std::vector<double> crossings(const Polygon& polygon, const Point2& along, const Point2& right,
                              double offset) {
  std::vector<double> t;
  const auto cut = [&](const Polyline& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2& a = ring[i];
      const Point2& b = ring[(i + 1) % ring.size()];
      const double side_a = right.dot(a) - offset;
      const double side_b = right.dot(b) - offset;
      if ((side_a > 0.0) == (side_b > 0.0)) continue;
      t.push_back(along.dot(a) + side_a / (side_a - side_b) * along.dot(b - a));
    }
  };
  cut(polygon.outer);
  for (const Polyline& hole : polygon.holes) cut(hole);
  std::sort(t.begin(), t.end());
  return t;
}

std::pair<double, double> extent(const Polyline& ring, const Point2& axis) {
  double low = axis.dot(ring.front());
  double high = low;
  for (const Point2& p : ring) {
    low = std::min(low, axis.dot(p));
    high = std::max(high, axis.dot(p));
  }
  return {low, high};
}

}  // namespace

Result<std::vector<Row>> generate_rows(const RowParcel& parcel) {
  const double spacing = parcel.row_spacing_m;
  if (!(spacing > 0.0)) {
    return fail(ErrorCode::kOutOfRange, fmt::format("{} is out of range", spacing),
                "must be greater than 0", Location{{}, 0, "row_spacing_m"});
  }
  std::vector<Row> rows;
  if (!parcel.boundary.outer.empty()) {
    const Point2 along(std::cos(parcel.row_heading_rad), std::sin(parcel.row_heading_rad));
    const Point2 right(along.y(), -along.x());
    const auto [low, high] = extent(parcel.boundary.outer, right);
    const double count = std::floor((high - low) / spacing + kCountSlack);
    if (!(count <= kMostRows)) {
      return fail(ErrorCode::kOutOfRange, fmt::format("{} makes {} rows", spacing, count),
                  fmt::format("a parcel holds at most {} rows", kMostRows),
                  Location{{}, 0, "row_spacing_m"});
    }
    const double first = 0.5 * (low + high) - 0.5 * (count - 1.0) * spacing;
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const double offset = first + i * spacing;
      const auto t = crossings(parcel.boundary, along, right, offset);
      for (std::size_t k = 0; k + 1 < t.size(); k += 2) {
        const double begin = t[k] + parcel.headland_width_m;
        const double end = t[k + 1] - parcel.headland_width_m;
        if (end - begin <= 2.0 * spacing) continue;  // a corner, not worth a row
        rows.push_back({fmt::format("r{}", rows.size() + 1),
                        {begin * along + offset * right, end * along + offset * right}});
      }
    }
  }
  if (rows.empty()) {
    return fail(
        ErrorCode::kNoRows,
        fmt::format("no row longer than {} m fits into parcel '{}'", 2.0 * spacing, parcel.id),
        "give a smaller row_spacing_m or headland_width_m, or another row_heading_deg");
  }
  return rows;
}

namespace internal {

RowFit fit_rows(const RowParcel& parcel) {
  // Doubled angles: a row driven the other way has the same direction.
  Point2 doubled(0.0, 0.0);
  for (const Row& row : parcel.rows) {
    const Point2 d = row.line.back() - row.line.front();
    const double angle = 2.0 * std::atan2(d.y(), d.x());
    doubled += d.norm() * Point2(std::cos(angle), std::sin(angle));
  }
  RowFit fit;
  fit.heading_rad = 0.5 * std::atan2(doubled.y(), doubled.x());
  const Point2 first = parcel.rows.front().line.back() - parcel.rows.front().line.front();
  const Point2 along(std::cos(fit.heading_rad), std::sin(fit.heading_rad));
  if (along.dot(first) < 0.0) fit.heading_rad = wrap_angle(fit.heading_rad + kPi);

  const Point2 right(std::sin(fit.heading_rad), -std::cos(fit.heading_rad));
  std::vector<double> offsets;
  for (const Row& row : parcel.rows) {
    offsets.push_back(0.5 * right.dot(row.line.front() + row.line.back()));
  }
  std::sort(offsets.begin(), offsets.end());
  std::vector<double> gaps;
  for (std::size_t i = 1; i < offsets.size(); ++i) {
    // Pieces of one line, cut in two by a path or a tree, are no neighbours.
    if (offsets[i] - offsets[i - 1] > 0.3) gaps.push_back(offsets[i] - offsets[i - 1]);
  }
  if (gaps.empty()) {
    double total = 0.0;
    for (const Row& row : parcel.rows) total += length(row.line);
    fit.spacing_m = area(parcel.boundary) / total;
    return fit;
  }
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  fit.spacing_m = *middle;
  return fit;
}

}  // namespace internal
}  // namespace headland
