// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <geos_c.h>

namespace headland {
namespace {

constexpr int kQuadrantSegments = 16;  // of a rounded corner

// Signed area, positive for a counter-clockwise ring.
double signed_area(const Polyline& ring) {
  double twice = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    // Relative to the first point: keeps the digits of rings far from the origin.
    const Point2 a = ring[i] - ring[0];
    const Point2 b = ring[(i + 1) % ring.size()] - ring[0];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return 0.5 * twice;
}

bool crossing_number_is_odd(const Polyline& ring, const Point2& p) {
  bool odd = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point2& a = ring[i];
    const Point2& b = ring[j];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    const double x = a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    odd ^= x > p.x();
  }
  return odd;
}

void drop_repeated_points(Polyline& ring) {
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
}

// A GEOS context with its geometries: every handle is freed with it, in the right order. One per
// call, so that callers may be on any thread.
class Geos {
 public:
  struct Free {
    GEOSContextHandle_t context;
    void operator()(GEOSGeometry* g) const { GEOSGeom_destroy_r(context, g); }
  };
  using Geometry = std::unique_ptr<GEOSGeometry, Free>;

  Geos() : context_(GEOS_init_r()) {}
  ~Geos() { GEOS_finish_r(context_); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;

  GEOSContextHandle_t handle() const { return context_; }
  Geometry own(GEOSGeometry* g) const { return Geometry(g, Free{context_}); }

  GEOSCoordSequence* sequence(const Polyline& line, bool closed) const {
    std::vector<double> xy;
    xy.reserve(2 * line.size() + 2);
    for (const Point2& p : line) xy.insert(xy.end(), {p.x(), p.y()});
    if (closed) xy.insert(xy.end(), {line.front().x(), line.front().y()});
    return GEOSCoordSeq_copyFromBuffer_r(context_, xy.data(), static_cast<unsigned>(xy.size() / 2),
                                         0, 0);
  }

  Geometry polygon(const Polygon& p) const {
    std::vector<GEOSGeometry*> holes;
    for (const Polyline& hole : p.holes) {
      if (hole.size() >= 3) holes.push_back(ring(hole));
    }
    return own(GEOSGeom_createPolygon_r(context_, ring(p.outer), holes.data(),
                                        static_cast<unsigned>(holes.size())));
  }

  // The union of the list: one valid geometry, whatever the list.
  Geometry area(const std::vector<Polygon>& list) const {
    std::vector<GEOSGeometry*> parts;
    for (const Polygon& p : list) {
      if (p.outer.size() < 3) continue;
      Geometry part = polygon(p);
      if (GEOSisValid_r(context_, part.get()) != 1) {
        part = own(GEOSMakeValid_r(context_, part.get()));
      }
      if (part) parts.push_back(part.release());
    }
    const Geometry all = own(GEOSGeom_createCollection_r(
        context_, GEOS_GEOMETRYCOLLECTION, parts.data(), static_cast<unsigned>(parts.size())));
    return own(GEOSUnaryUnion_r(context_, all.get()));
  }

  std::vector<Polygon> polygons(const Geometry& g) const {
    HEADLAND_CHECK(g != nullptr, "GEOS failed on a set operation of valid polygons");
    std::vector<Polygon> out;
    collect(g.get(), out);
    return out;
  }

 private:
  GEOSGeometry* ring(const Polyline& points) const {
    return GEOSGeom_createLinearRing_r(context_, sequence(points, true));
  }

  Polyline points(const GEOSGeometry* line) const {
    const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(context_, line);
    unsigned count = 0;
    GEOSCoordSeq_getSize_r(context_, sequence, &count);
    Polyline out(count);
    for (unsigned i = 0; i < count; ++i) {
      GEOSCoordSeq_getXY_r(context_, sequence, i, &out[i].x(), &out[i].y());
    }
    return out;
  }

  void collect(const GEOSGeometry* g, std::vector<Polygon>& out) const {
    if (GEOSGeomTypeId_r(context_, g) == GEOS_POLYGON) {
      if (GEOSisEmpty_r(context_, g) != 0) return;
      Polygon polygon{points(GEOSGetExteriorRing_r(context_, g)), {}};
      for (int i = 0; i < GEOSGetNumInteriorRings_r(context_, g); ++i) {
        polygon.holes.push_back(points(GEOSGetInteriorRingN_r(context_, g, i)));
      }
      if (auto clean = checked(std::move(polygon))) out.push_back(std::move(*clean));
      return;
    }
    if (GEOSGeomTypeId_r(context_, g) < GEOS_MULTIPOINT) return;  // stray points and lines
    for (int i = 0; i < GEOSGetNumGeometries_r(context_, g); ++i) {
      collect(GEOSGetGeometryN_r(context_, g, i), out);
    }
  }

  GEOSContextHandle_t context_;
};

// True where all points lie within 1e-9 m of one line.
bool is_flat(const Polyline& ring) {
  const Point2 far = *std::max_element(ring.begin(), ring.end(), [&](const auto& a, const auto& b) {
    return (a - ring[0]).squaredNorm() < (b - ring[0]).squaredNorm();
  });
  const Point2 along = (far - ring[0]).normalized();
  return std::all_of(ring.begin(), ring.end(), [&](const Point2& p) {
    const Point2 d = p - ring[0];
    return std::abs(along.x() * d.y() - along.y() * d.x()) < 1e-9;
  });
}

std::optional<Error> validity_error(const Polygon& polygon) {
  const Geos geos;
  const auto geometry = geos.polygon(polygon);
  char* reason = nullptr;
  GEOSGeometry* place = nullptr;
  const char valid = GEOSisValidDetail_r(geos.handle(), geometry.get(), 0, &reason, &place);
  const auto owned_place = geos.own(place);
  std::string text = reason != nullptr ? reason : "invalid";
  GEOSFree_r(geos.handle(), reason);
  if (valid == 1) return std::nullopt;
  double x = 0.0;
  double y = 0.0;
  if (place != nullptr) {
    GEOSGeomGetX_r(geos.handle(), place, &x);
    GEOSGeomGetY_r(geos.handle(), place, &y);
  }
  if (text == "Self-intersection" || text == "Ring Self-intersection") {
    text = "the boundary crosses or touches itself";
  }
  return Error{ErrorCode::kBadGeometry,
               fmt::format("{} at ({:.3f}, {:.3f}) m", text, x, y),
               "rings must not cross themselves or each other, and holes must lie inside",
               {}};
}

}  // namespace

double length(const Polyline& line) {
  double sum = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) sum += (line[i] - line[i - 1]).norm();
  return sum;
}

double distance_to_segment(const Point2& p, const Point2& a, const Point2& b) {
  const Point2 ab = b - a;
  const double squared = ab.squaredNorm();
  const double t = squared > 0.0 ? std::clamp((p - a).dot(ab) / squared, 0.0, 1.0) : 0.0;
  return (p - (a + t * ab)).norm();
}

double area(const Polygon& polygon) {
  if (polygon.outer.empty()) return 0.0;
  double sum = std::abs(signed_area(polygon.outer));
  for (const Polyline& hole : polygon.holes) {
    if (!hole.empty()) sum -= std::abs(signed_area(hole));
  }
  return sum;
}

bool contains(const Polygon& polygon, const Point2& p) {
  if (polygon.outer.empty() || !crossing_number_is_odd(polygon.outer, p)) return false;
  return std::none_of(polygon.holes.begin(), polygon.holes.end(), [&](const Polyline& hole) {
    return !hole.empty() && crossing_number_is_odd(hole, p);
  });
}

Result<Polygon> checked(Polygon polygon) {
  drop_repeated_points(polygon.outer);
  for (Polyline& hole : polygon.holes) drop_repeated_points(hole);
  std::erase_if(polygon.holes, [](const Polyline& hole) { return hole.empty(); });
  const auto bad_ring = [](const Polyline& ring) {
    return ring.size() < 3 || is_flat(ring) ||
           std::any_of(ring.begin(), ring.end(), [](const Point2& p) { return !p.allFinite(); });
  };
  if (bad_ring(polygon.outer) ||
      std::any_of(polygon.holes.begin(), polygon.holes.end(), bad_ring)) {
    return fail(ErrorCode::kBadGeometry, "the polygon has no area",
                "a ring needs at least three points that do not lie on one line");
  }
  if (auto error = validity_error(polygon)) return tl::unexpected<Error>(std::move(*error));
  if (signed_area(polygon.outer) < 0.0) std::reverse(polygon.outer.begin(), polygon.outer.end());
  for (Polyline& hole : polygon.holes) {
    if (signed_area(hole) > 0.0) std::reverse(hole.begin(), hole.end());
  }
  return polygon;
}

std::vector<Polygon> unite(const std::vector<Polygon>& a) {
  const Geos geos;
  return geos.polygons(geos.area(a));
}

std::vector<Polygon> subtract(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  const Geos geos;
  const auto left = geos.area(a);
  const auto right = geos.area(b);
  return geos.polygons(geos.own(GEOSDifference_r(geos.handle(), left.get(), right.get())));
}

std::vector<Polygon> intersect(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  const Geos geos;
  const auto left = geos.area(a);
  const auto right = geos.area(b);
  return geos.polygons(geos.own(GEOSIntersection_r(geos.handle(), left.get(), right.get())));
}

std::vector<Polygon> grow(const std::vector<Polygon>& a, double distance) {
  const Geos geos;
  const auto all = geos.area(a);
  return geos.polygons(
      geos.own(GEOSBuffer_r(geos.handle(), all.get(), distance, kQuadrantSegments)));
}

std::vector<Polygon> widen(const Polyline& line, double width) {
  if (line.size() < 2 || width <= 0.0) return {};
  const Geos geos;
  const auto geometry =
      geos.own(GEOSGeom_createLineString_r(geos.handle(), geos.sequence(line, false)));
  return geos.polygons(
      geos.own(GEOSBufferWithStyle_r(geos.handle(), geometry.get(), 0.5 * width, kQuadrantSegments,
                                     GEOSBUF_CAP_FLAT, GEOSBUF_JOIN_ROUND, 0.0)));
}

}  // namespace headland
