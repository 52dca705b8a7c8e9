// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "core/config/visit.hpp"
#include "core/geometry/angle.hpp"

namespace headland {

/// Where a sensor sits on a vehicle.
struct SensorMount {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double roll_deg = 0.0;
  double pitch_deg = 0.0;
  double yaw_deg = 0.0;

  template <class V>
  void visit(V& v) {
    v("x_m", x_m, config::Range{-20.0, 20.0}, "Ahead of base [m]");
    v("y_m", y_m, config::Range{-20.0, 20.0}, "To the left of base [m]");
    v("z_m", z_m, config::Range{-5.0, 20.0}, "Above the ground below base [m]");
    v("roll_deg", roll_deg, config::Range{-180.0, 180.0}, "Left side up [deg]; 180: upside down");
    v("pitch_deg", pitch_deg, config::Range{-90.0, 90.0}, "Nose down [deg]");
    v("yaw_deg", yaw_deg, config::Range{-180.0, 180.0}, "To the left [deg]");
  }

  /// T_base_sensor: yaw about z, then pitch about y, then roll about x. base lies on the ground.
  Eigen::Isometry3d pose() const {
    return Eigen::Translation3d(x_m, y_m, z_m) *
           Eigen::AngleAxisd(deg_to_rad(yaw_deg), Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(deg_to_rad(pitch_deg), Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(deg_to_rad(roll_deg), Eigen::Vector3d::UnitX());
  }
};

}  // namespace headland
