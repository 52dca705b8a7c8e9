// SPDX-License-Identifier: Apache-2.0
#include "core/world/geodesy.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

constexpr double kA = 6378137.0;  // WGS84
constexpr double kF = 1.0 / 298.257223563;

TEST(Geodesy, RoundTripIsExactToABillionthOfADegree) {
  RandomStream random(1, "geodesy");
  for (int i = 0; i < 500; ++i) {
    const LatLon origin{random.uniform(-85, 85), random.uniform(-180, 180)};
    const LocalFrame frame(origin);
    const Point2 p(random.uniform(-20e3, 20e3), random.uniform(-20e3, 20e3));
    const LatLon there = frame.to_wgs84(p);
    EXPECT_LT((frame.to_map(there) - p).norm(), 1e-6);
    const LatLon back = frame.to_wgs84(frame.to_map(there));
    EXPECT_NEAR(back.lat_deg, there.lat_deg, 1e-9);
    EXPECT_NEAR(std::remainder(back.lon_deg - there.lon_deg, 360.0), 0.0, 1e-9);
  }
}

TEST(Geodesy, OriginIsZeroAndAxesAreEastAndNorth) {
  const LocalFrame frame({42.1628, 3.0930});
  EXPECT_LT(frame.to_map({42.1628, 3.0930}).norm(), 1e-9);
  EXPECT_GT(frame.to_map({42.1628, 3.0931}).x(), 8.0);
  EXPECT_GT(frame.to_map({42.1629, 3.0930}).y(), 11.0);
}

// Small steps have the lengths that the radii of curvature give: M north, N cos(lat) east.
TEST(Geodesy, ScaleIsThatOfTheEllipsoid) {
  const double e2 = kF * (2.0 - kF);
  for (const double lat : {-60.0, -10.0, 0.0, 37.9437, 42.1628, 51.5972}) {
    const double s = std::sin(deg_to_rad(lat));
    const double w = 1.0 - e2 * s * s;
    const double meridian = kA * (1.0 - e2) / (w * std::sqrt(w));
    const double normal = kA / std::sqrt(w);
    const LocalFrame frame({lat, 10.0});
    const double step = deg_to_rad(0.001);
    EXPECT_NEAR(frame.to_map({lat + 0.001, 10.0}).y(), meridian * step, 1e-3);
    EXPECT_NEAR(frame.to_map({lat, 10.001}).x(), normal * std::cos(deg_to_rad(lat)) * step, 1e-3);
  }
}

}  // namespace
}  // namespace headland
