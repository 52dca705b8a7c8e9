// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/world/lidar.hpp"

namespace headland::internal {

// The plane normal . p + constant = 0 with a unit normal that points up; normal . p + constant is
// the height of p above it [m].
struct FittedPlane {
  Eigen::Vector3d normal{0.0, 0.0, 1.0};
  double constant_m = 0.0;
  int inliers = 0;

  double height(const Eigen::Vector3d& p) const { return normal.dot(p) + constant_m; }
};

struct PlaneFitConfig {
  int iterations = 100;
  double inlier_m = 0.1;
  double steepest_rad = 0.35;   // of the normal against +z; pi: any plane
  double height_prior_m = 0.5;  // how far the plane may lie from base's origin; infinity: any
  int least_inliers = 60;
  double below_weight = 0.0;  // what a point well below the plane costs, in inliers
};

// RANSAC over three points at a time (Fischler and Bolles 1981); only planes within the limits of
// `config` count. The one with the most inliers wins, less what lies below it: nothing does below
// the ground, much does below a slice through a canopy. With limits the best one is refined by
// least squares over its inliers; without (seed 000 as published) it stays as sampled.
// Deterministic for a given `seed`. O(iterations x points). nullopt without such a plane, or with
// fewer inliers than demanded.
std::optional<FittedPlane> fit_plane(std::span<const Eigen::Vector3d> points,
                                     const PlaneFitConfig& config, std::uint64_t seed);

// The ground below the vehicle from a scan in `base`: of the points near base's height the lowest
// of each cell of a metre, through fit_plane with limits. `scratch` is reused. O(points).
std::optional<FittedPlane> fit_ground(std::span<const LidarPoint> points_base,
                                      const PlaneFitConfig& config,
                                      std::vector<Eigen::Vector3d>& scratch);

}  // namespace headland::internal
