// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"
#include "core/world/camera.hpp"

namespace headland {

inline constexpr ClassProbability kUnknownClass = {0.25, 0.25, 0.25, 0.25};

/// Something that stands out of the ground in one scan, and may be someone.
struct Detection {
  Point2 position{0.0, 0.0};  ///< centre of the body, in `map` [m]
  Eigen::Matrix2d covariance = 0.01 * Eigen::Matrix2d::Identity();  ///< of the position [m2]
  double across_m = 0.5;  ///< extent seen, across the line of sight
  double along_m = 0.5;   ///< ... and along it
  double height_m = 1.0;  ///< of its top above the ground
  int points_count = 0;
  int cluster = -1;  ///< what the caller knows it by
  /// Of its points, in `map` [m]: for taking merged bodies apart. May be empty. Not owned.
  std::span<const Point2> points{};
  ClassProbability probability = kUnknownClass;
};

/// How a body's centre follows from the side of it that a sensor sees.
struct BodyConfig {
  double near_quantile_ratio = 0.15;
  double deepest_m = 1.0;
  double noise_m = 0.08;
  double noise_ratio = 0.006;

  template <class V>
  void visit(V& v) {
    v("near_quantile_ratio", near_quantile_ratio, config::kFraction,
      "So many of the points count as noise before the near side");
    v("deepest_m", deepest_m, config::kPositive,
      "Bodies are as deep as they are wide, but for these: livestock seen from its side [m]");
    v("noise_m", noise_m, config::kPositive, "Standard deviation of a centre, close by [m]");
    v("noise_ratio", noise_ratio, config::kNonNegative, "... and per metre of range");
  }
};

/// The body behind the points of one cluster: its near side is seen, its centre lies half its depth
/// behind, and it is taken to be as deep as wide.
/// @param points in `map` [m]; those that are not finite are ignored.
/// @param sensor where the lidar was, in `map` [m].
/// @param width across the line of sight, if more is known than these points show [m].
/// @return nullopt without a finite point, or without a finite sensor. `points` is kept in it;
///         height and class are left for the caller. O(n), does not allocate.
std::optional<Detection> detect_body(std::span<const Point2> points, const Point2& sensor,
                                     const BodyConfig& config, double width = 0.0);

/// Whether it can be used: finite, its covariance positive, its probabilities from 0 to 1.
bool is_sound(const Detection& detection);

}  // namespace headland
