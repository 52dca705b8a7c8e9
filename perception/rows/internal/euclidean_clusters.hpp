// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace headland::internal {

// Cluster of each point: two points within `tolerance` [m] of each other are in one cluster.
// Clusters are numbered from 0 in the order of their first points. O(n) for evenly thinned points.
std::vector<int> euclidean_clusters(std::span<const Eigen::Vector2d> points, double tolerance);

}  // namespace headland::internal
