// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/config/visit.hpp"
#include "core/world/camera.hpp"

namespace headland {

struct AssociationConfig {
  double trimmed_ratio = 0.02;
  double tail_ratio = 0.15;
  double least_iou_ratio = 0.3;
  double centre_weight = 0.5;
  int least_points_count = 5;
  double depth_order_ratio = 0.5;
  double least_score_ratio = 0.3;
  double missing_ratio = 0.05;

  template <class V>
  void visit(V& v) {
    v("trimmed_ratio", trimmed_ratio, config::Range{0.0, 0.4},
      "So many of a cluster's pixels at each side of its box may be strays");
    v("tail_ratio", tail_ratio, config::kFraction,
      "... but not those that are this near to the others, over the extent of these");
    v("least_iou_ratio", least_iou_ratio, config::kFraction,
      "A cluster and a box that overlap less are not of one body");
    v("centre_weight", centre_weight, config::kNonNegative,
      "Of the distance of centres, over the box's diagonal, in a pair's cost");
    v("least_points_count", least_points_count, config::Range{1, 100000},
      "Clusters with fewer points on the image have no box");
    v("depth_order_ratio", depth_order_ratio, config::kFraction,
      "A cluster does not get a box when a nearer one covers so much of the cluster");
    v("least_score_ratio", least_score_ratio, config::kFraction, "Boxes below are not looked at");
    v("missing_ratio", missing_ratio, config::Range{0.0, 0.5},
      "Least probability of a class, however sure the detector is");
  }
};

/// Where a cluster lies on the image.
struct ClusterBox {
  ImageBox box;          ///< clipped to the image [px]
  double depth_m = 0.0;  ///< distance of its middle from base [m]
  int points_count = 0;  ///< on the image
};

/// A cluster's box on the image: the quantiles of its pixels, so that a stray point does not
/// stretch it, clipped to the image. nullopt if too few points fall on the image.
/// @param points in `base` [m]; those not finite or behind the camera are ignored. O(n).
std::optional<ClusterBox> project_cluster(std::span<const Eigen::Vector3f> points,
                                          const CameraModel& camera,
                                          const AssociationConfig& config);

/// Intersection over union, 0 to 1; 0 for empty boxes.
double box_overlap(const ImageBox& a, const ImageBox& b);

/// Which box of the camera is of which cluster of the lidar: projected clusters and boxes are
/// paired one to one by overlap and distance of their centres. Seed 003, III-B.
struct Association {
  /// Of each cluster: place of its box, -1: none.
  std::vector<int> box_of;
  /// Of each cluster: overlap with it, 0: none.
  std::vector<double> overlap;
  /// Of each cluster: as the detector says, weighted by the overlap; even without a box.
  std::vector<ClassProbability> probability;
};

/// Pairs clusters (nullopt: not on the image) with boxes. Those of one box are in plausible order
/// of depth: not behind another cluster that covers them and has no box. Boxes that are not finite
/// are left out. Deterministic. O(c b (c + b)).
Association associate_boxes(std::span<const std::optional<ClusterBox>> clusters,
                            std::span<const DetectedBox> boxes, const AssociationConfig& config);

}  // namespace headland
