// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/pose2.hpp"
#include "core/world/lidar.hpp"

namespace headland::test {

/// Straight rows along the map's x axis on level ground, as a spinning lidar sees them: trunks are
/// circles, canopy is a porous box along the row, grass and noise on the ground.
struct RowScene {
  std::vector<double> rows_m{-5.7, -1.9, 1.9, 5.7};  ///< y of each row
  double begin_m = 0.0;
  double end_m = 60.0;
  double next_begin_m = 1e9;  ///< the next block's rows, to next_end_m
  double next_end_m = 1e9;
  double trunk_pitch_m = 1.0;
  double trunk_radius_m = 0.05;
  double canopy_low_m = 0.6;
  double canopy_high_m = 3.0;
  double canopy_half_width_m = 0.5;
  double leaf_1pm = 1.2;  ///< extinction along a ray [1/m]
  double place_deviation_m = 0.03;
  double half_turn_rad = kPi;  ///< of the view; pi / 2: only what lies ahead
  double azimuth_step_deg = 0.4;
  double sensor_z_m = 1.5;
  int lasers_count = 16;

  /// One turn from `base` at rest in the map, points in `base`.
  std::vector<LidarPoint> scan(const Pose2& base, RandomStream& random) const {
    std::vector<LidarPoint> points;
    const double step = deg_to_rad(azimuth_step_deg);
    for (double azimuth = -half_turn_rad; azimuth < half_turn_rad; azimuth += step) {
      for (int laser = 0; laser < lasers_count; ++laser) {
        const double span = lasers_count > 1 ? 30.0 / (lasers_count - 1) : 0.0;
        const double elevation = deg_to_rad(-15.0 + span * laser);
        const double range = range_of(base, azimuth, elevation, random) + 0.01 * random.normal();
        if (!(range < 80.0)) continue;
        const double flat = range * std::cos(elevation);
        const Eigen::Vector3d p(flat * std::cos(azimuth), flat * std::sin(azimuth),
                                sensor_z_m + range * std::sin(elevation));
        points.push_back({p.cast<float>(), 0.3f, 0.0f, static_cast<std::uint16_t>(laser)});
      }
    }
    return points;
  }

 private:
  bool is_grown(double x) const {
    return (x >= begin_m && x <= end_m) || (x >= next_begin_m && x <= next_end_m);
  }

  // Of the trunk nearest to x: the same in every scan.
  static double jitter(double row, double index) {
    const double wave = std::sin(12.9898 * index + 78.233 * row) * 43758.5453;
    return 2.0 * (wave - std::floor(wave)) - 1.0;
  }

  double range_of(const Pose2& base, double azimuth, double elevation, RandomStream& random) const {
    const double yaw = base.yaw + azimuth;
    const Eigen::Vector3d direction(std::cos(elevation) * std::cos(yaw),
                                    std::cos(elevation) * std::sin(yaw), std::sin(elevation));
    const Eigen::Vector3d origin(base.x, base.y, sensor_z_m);
    double nearest = 1e9;
    if (direction.z() < 0.0) {
      const double soil = 0.1 * random.uniform();
      nearest = (soil - origin.z()) / direction.z();
    }
    for (const double row : rows_m) {
      nearest = std::min(nearest, row_range(row, origin, direction, nearest, random));
    }
    return nearest;
  }

  double row_range(double row, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                   double farthest, RandomStream& random) const {
    if (std::abs(direction.y()) < 1e-6) return farthest;
    const double a = (row - canopy_half_width_m - origin.y()) / direction.y();
    const double b = (row + canopy_half_width_m - origin.y()) / direction.y();
    const double leaves = std::min({a, b}) < 0.0 && std::max(a, b) < 0.0 ? farthest : 0.0;
    if (leaves > 0.0) return farthest;
    const double step = 0.05;
    const double last = std::min({std::max(a, b), farthest, 60.0});
    for (double t = std::max(0.0, std::min(a, b)); t < last; t += step) {
      const Eigen::Vector3d p = origin + t * direction;
      if (!is_grown(p.x())) continue;
      if (p.z() < canopy_high_m && is_in_trunk(row, p)) return t;
      if (p.z() > canopy_low_m && p.z() < canopy_high_m &&
          random.uniform() < 1.0 - std::exp(-leaf_1pm * step)) {
        return t;
      }
    }
    return farthest;
  }

  bool is_in_trunk(double row, const Eigen::Vector3d& p) const {
    const double index = std::round(p.x() / trunk_pitch_m);
    const double x = index * trunk_pitch_m;
    const double y = row + 1.7 * place_deviation_m * jitter(row, index);
    return std::hypot(p.x() - x, p.y() - y) < trunk_radius_m;
  }
};

/// Pose of `to` in `from`, both in the map: what perfect odometry says.
inline Pose2 moved_between(const Pose2& from, const Pose2& to) { return inverse(from) * to; }

}  // namespace headland::test
