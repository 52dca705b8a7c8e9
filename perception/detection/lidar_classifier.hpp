// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/config/visit.hpp"
#include "core/world/camera.hpp"

namespace headland {

/// What a lidar says of a body, without any camera.
struct BodyShape {
  double height_m = 0.0;   ///< of its top above the ground
  double extent_m = 0.0;   ///< the larger one seen, across or along the line of sight
  double speed_mps = 0.0;  ///< of its track; 0 if it is not known
  double range_m = 0.0;    ///< from the sensor
  int points_count = 0;
};

struct LidarClassifierConfig {
  double ring_step_deg = 2.0;
  double azimuth_step_deg = 0.2;
  double moving_mps = 0.4;
  double still_ratio = 0.02;
  double fullest_ratio = 0.3;
  double least_ratio = 0.02;

  template <class V>
  void visit(V& v) {
    v("ring_step_deg", ring_step_deg, config::kPositive,
      "Between the lidar's rings: tops are known this well [deg]");
    v("azimuth_step_deg", azimuth_step_deg, config::kPositive, "Between its shots [deg]");
    v("moving_mps", moving_mps, config::kPositive, "Who is faster than this moves [m/s]");
    v("still_ratio", still_ratio, config::Range{0.001, 1.0},
      "Of what is nobody (posts, bushes), so much seems to move");
    v("fullest_ratio", fullest_ratio, config::kFraction,
      "Solid bodies have at least so much of the points that fit on them");
    v("least_ratio", least_ratio, config::Range{0.0, 0.2},
      "Least probability of a class, however clear the shape is");
  }
};

/// Probability of each class by height, extent, speed and how full of points it is: normal
/// densities of people, sheep and cattle (from the side and from an end) and vehicles, against a
/// wide one of all else. An even chance for what is no number or has no size. Deterministic, about
/// 1 us.
ClassProbability classify_shape(const BodyShape& shape, const LidarClassifierConfig& config = {});

}  // namespace headland
