// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/pose2.hpp"

namespace headland {

using Polyline = std::vector<Point2>;  ///< [m]

double length(const Polyline& line);
/// Distance [m] from a point to a segment.
double distance_to_segment(const Point2& p, const Point2& a, const Point2& b);

/// A polygon with holes. Rings are not closed (the first point is not repeated); the outer ring
/// runs counter-clockwise, holes clockwise, once it has passed `checked`.
struct Polygon {
  Polyline outer;
  std::vector<Polyline> holes;
};

/// Area [m2], holes taken out.
double area(const Polygon& polygon);
bool contains(const Polygon& polygon, const Point2& p);

/// The polygon with its rings oriented and repeated points dropped. Error kBadGeometry for fewer
/// than three distinct points, zero area, or a ring that crosses itself (naming the place).
Result<Polygon> checked(Polygon polygon);

// Set operations on areas, each a list of polygons (GEOS; exact up to its rounding). The lists may
// overlap or cross themselves; the results are disjoint and pass `checked`.
std::vector<Polygon> unite(const std::vector<Polygon>& a);
std::vector<Polygon> subtract(const std::vector<Polygon>& a, const std::vector<Polygon>& b);
std::vector<Polygon> intersect(const std::vector<Polygon>& a, const std::vector<Polygon>& b);
/// Grown by `distance` [m] with round corners; negative shrinks.
std::vector<Polygon> grow(const std::vector<Polygon>& a, double distance);
/// A line widened to `width` [m], flat at its ends.
std::vector<Polygon> widen(const Polyline& line, double width);

}  // namespace headland
