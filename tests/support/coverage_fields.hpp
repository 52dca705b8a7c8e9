// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <fmt/format.h>

#include "core/model/vehicle.hpp"
#include "core/world/farm.hpp"

namespace headland::test {

/// A block of parallel rows along +y. Skewed: each row begins and ends `skew` [m] farther along
/// than its neighbour to the left, and so does the boundary.
struct FieldShape {
  int rows = 10;
  double length = 40.0;    // [m]
  double spacing = 2.5;    // [m]
  double headland = 20.0;  // [m] beyond both ends
  double side = 20.0;      // [m] beside the outermost rows' bodies
  double skew = 0.0;       // [m] per row
};

inline RowParcel make_parcel(const FieldShape& shape, const Point2& corner = {0.0, 0.0},
                             const std::string& id = "p") {
  RowParcel parcel;
  parcel.id = id;
  parcel.row_spacing_m = shape.spacing;
  parcel.row_heading_rad = 0.5 * kPi;
  const double width = shape.rows * shape.spacing;
  const double slope = shape.skew / shape.spacing;
  const auto at = [&](double x, double y) -> Point2 { return corner + Point2(x, y + slope * x); };
  parcel.boundary.outer = {at(-shape.side, -shape.headland),
                           at(width + shape.side, -shape.headland),
                           at(width + shape.side, shape.length + shape.headland),
                           at(-shape.side, shape.length + shape.headland)};
  for (int i = 0; i < shape.rows; ++i) {
    const double x = (i + 0.5) * shape.spacing;
    parcel.rows.push_back({fmt::format("{}.{}", id, i + 1), {at(x, 0.0), at(x, shape.length)}});
  }
  return parcel;
}

inline Farm make_field(const FieldShape& shape) {
  Farm farm;
  farm.row_parcels.push_back(make_parcel(shape));
  return farm;
}

inline std::vector<Row> all_rows(const Farm& farm) {
  std::vector<Row> rows;
  for (const RowParcel& parcel : farm.row_parcels) {
    rows.insert(rows.end(), parcel.rows.begin(), parcel.rows.end());
  }
  return rows;
}

/// Parcels in a grid, each amid roads: `columns` x `lines` blocks of `rows` rows of 100 m.
inline Farm make_estate(int columns, int lines, int rows) {
  Farm farm;
  const FieldShape shape{rows, 100.0, 2.4, 9.0, 1.0, 0.0};
  const double gap = 6.0;
  const double width = rows * shape.spacing + 2.0 * shape.side + gap;
  const double height = shape.length + 2.0 * shape.headland + gap;
  for (int c = 0; c < columns; ++c) {
    for (int l = 0; l < lines; ++l) {
      farm.row_parcels.push_back(make_parcel(shape, {c * width, l * height},
                                             fmt::format("{}{}", static_cast<char>('a' + c), l)));
    }
  }
  const double left = -shape.side - 0.5 * gap;
  const double low = -shape.headland - 0.5 * gap;
  for (int c = 0; c <= columns; ++c) {
    const double x = left + c * width;
    farm.roads.push_back(
        {fmt::format("v{}", c), {{x, low - 3.0}, {x, low + lines * height + 3.0}}, gap + 0.2});
  }
  for (int l = 0; l <= lines; ++l) {
    const double y = low + l * height;
    farm.roads.push_back(
        {fmt::format("h{}", l), {{left - 3.0, y}, {left + columns * width + 3.0, y}}, gap + 0.2});
  }
  return farm;
}

inline Vehicle tractor() {
  Vehicle v;
  v.name = "tractor";
  v.wheelbase_m = 2.1;
  v.max_steering_deg = 40.0;
  v.min_turning_radius_m = 3.2;
  v.footprint = {2.9, 0.9, 1.5};
  return v;
}

inline Vehicle tracked_robot() {
  Vehicle v;
  v.name = "tracked robot";
  v.steering = Steering::kDifferential;
  v.min_turning_radius_m = 0.8;
  v.footprint = {1.0, 1.0, 1.2};
  return v;
}

}  // namespace headland::test
