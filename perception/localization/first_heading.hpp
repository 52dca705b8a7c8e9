// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/pose2.hpp"

namespace headland {

/// Finds where `odom` lies in the map from positions alone, once enough way has been driven: the
/// rotation and shift that bring the odometry's places of the antenna onto the fixes (least squares
/// of Kabsch in the plane, re-weighted after Huber). A few wrong fixes do no harm.
class FirstHeading {
 public:
  struct Found {
    Pose2 T_map_base;
    Eigen::Matrix3d covariance;  ///< x [m], y [m], yaw [rad]
  };

  explicit FirstHeading(const Point2& antenna);

  /// The vehicle moved, by the odometry.
  void move(const Pose2& moved) { T_odom_base_ = T_odom_base_ * moved; }
  /// A position of the antenna in the map [m] with its standard deviation per axis [m]. Returns the
  /// pose once its yaw is surer than 6 deg. O(fixes kept), which are at most 64.
  std::optional<Found> add(const Point2& fix, double deviation);

  bool empty() const { return pairs_.empty(); }
  void clear() { pairs_.clear(); }

 private:
  struct Pair {
    Point2 p_odom;
    Point2 p_map;
    double deviation;
    double weight;
  };
  struct Fit {
    double yaw = 0.0;
    Point2 mean_odom{0.0, 0.0};
    Point2 mean_map{0.0, 0.0};
    double weight = 0.0;  // sum [1/m2]
    double spread = 0.0;  // sum of weighted squared distances from the mean
  };
  Fit fit() const;
  void reweight(const Fit& fit);

  Point2 antenna_;
  Pose2 T_odom_base_;
  std::vector<Pair> pairs_;
};

}  // namespace headland
