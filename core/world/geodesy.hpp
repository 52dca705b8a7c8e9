// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/pose2.hpp"

namespace headland {

struct LatLon {
  double lat_deg = 0.0;
  double lon_deg = 0.0;
};

/// WGS84 <-> the farm's local east-north plane (GeographicLib's LocalCartesian, height 0).
class LocalFrame {
 public:
  LocalFrame() = default;
  explicit LocalFrame(LatLon origin) : origin_(origin) {}
  LatLon origin() const { return origin_; }
  Point2 to_map(LatLon position) const;  ///< [m] east, north of the origin
  LatLon to_wgs84(const Point2& p_map) const;

 private:
  LatLon origin_;
};

}  // namespace headland
