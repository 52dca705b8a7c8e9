// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/base/random.hpp"
#include "core/world/lidar.hpp"

namespace headland::testing {

/// Trunks and posts (upright cylinders) on level ground, and walls, as rays see them.
struct RayWorld {
  struct Trunk {
    double x, y, radius;
  };
  struct Wall {  // n . p = d, |n| = 1, n level
    Eigen::Vector3d n;
    double d;
  };
  std::vector<Trunk> trunks;
  std::vector<Wall> walls;

  double range(const Eigen::Vector3d& from, const Eigen::Vector3d& along) const {
    double best = std::numeric_limits<double>::infinity();
    const auto take = [&](double t) {
      if (t > 0.1 && t < best && from.z() + t * along.z() < 2.5) best = t;
    };
    if (along.z() < 0.0) take(-from.z() / along.z());
    for (const Wall& wall : walls) take((wall.d - wall.n.dot(from)) / wall.n.dot(along));
    const double a = along.x() * along.x() + along.y() * along.y();
    for (const Trunk& trunk : trunks) {
      const double dx = from.x() - trunk.x;
      const double dy = from.y() - trunk.y;
      const double b = dx * along.x() + dy * along.y();
      const double d = b * b - a * (dx * dx + dy * dy - trunk.radius * trunk.radius);
      if (b < 0.0 && d > 0.0) take((-b - std::sqrt(d)) / a);
    }
    return best;
  }

  /// One turn of a lidar with 16 rings (+-15 deg) and 900 shots each in 0.1 s; T_map_base by time
  /// after its first shot.
  LidarScan scan(const std::function<Eigen::Isometry3d(double)>& T_map_base,
                 const SensorMount& mount, double time_s, RandomStream& random) const {
    LidarScan scan;
    scan.time_s = time_s;
    const Eigen::Isometry3d T_base_sensor = mount.pose();
    for (int i = 0; i < 900; ++i) {
      const double offset = 0.1 * i / 900.0;
      const double azimuth = -2.0 * kPi * i / 900.0;
      const Eigen::Isometry3d T = T_map_base(offset) * T_base_sensor;
      for (int ring = 0; ring < 16; ++ring) {
        const double up = deg_to_rad(-15.0 + 2.0 * ring);
        const Eigen::Vector3d along{std::cos(up) * std::cos(azimuth),
                                    std::cos(up) * std::sin(azimuth), std::sin(up)};
        const double r = range(T.translation(), T.linear() * along) + 0.01 * random.normal();
        if (!(r < 60.0)) continue;
        scan.points.push_back({(r * along).cast<float>(), 0.5f, static_cast<float>(offset),
                               static_cast<std::uint16_t>(ring)});
      }
    }
    return scan;
  }
};

/// Two rows of trunks to either side of x, 4 m apart, `pitch` from trunk to trunk.
inline RayWorld orchard_of_trunks(double length, double pitch, std::uint64_t seed) {
  RandomStream random(seed, "orchard_of_trunks");
  RayWorld world;
  for (double x = -20.0; x < length; x += pitch) {
    for (const double y : {-6.0, -2.0, 2.0, 6.0}) {
      world.trunks.push_back(
          {x + 0.2 * random.normal(), y + 0.05 * random.normal(), random.uniform(0.06, 0.12)});
    }
  }
  return world;
}

}  // namespace headland::testing
