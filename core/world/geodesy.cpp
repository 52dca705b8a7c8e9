// SPDX-License-Identifier: Apache-2.0
#include "core/world/geodesy.hpp"

#include <GeographicLib/LocalCartesian.hpp>

namespace headland {
namespace {

// Cheap to make: two sines and cosines and a 3x3 matrix.
GeographicLib::LocalCartesian plane(LatLon origin) {
  return GeographicLib::LocalCartesian(origin.lat_deg, origin.lon_deg, 0.0,
                                       GeographicLib::Geocentric::WGS84());
}

}  // namespace

Point2 LocalFrame::to_map(LatLon position) const {
  Point2 p_map;
  double up = 0.0;
  plane(origin_).Forward(position.lat_deg, position.lon_deg, 0.0, p_map.x(), p_map.y(), up);
  return p_map;
}

LatLon LocalFrame::to_wgs84(const Point2& p_map) const {
  // The ellipsoid falls away below the plane (8 cm at 1 km): look for its point straight under
  // p_map, so that to_map and to_wgs84 undo each other. Each step leaves about (distance / Earth's
  // radius)^2 of the error, so that three are plenty.
  const auto local = plane(origin_);
  LatLon position;
  double up = 0.0;
  for (int i = 0; i < 4; ++i) {
    double height = 0.0;
    local.Reverse(p_map.x(), p_map.y(), up, position.lat_deg, position.lon_deg, height);
    up -= height;
  }
  return position;
}

}  // namespace headland
