// SPDX-License-Identifier: Apache-2.0
#include "perception/detection/association.hpp"

#include <algorithm>
#include <cmath>

#include "perception/tracking/assignment.hpp"
#include "perception/tracking/detection.hpp"

namespace headland {
namespace {

constexpr double kEven = 1.0 / kObjectClasses;

bool is_finite(const ImageBox& box) {
  return std::isfinite(box.left) && std::isfinite(box.top) && std::isfinite(box.right) &&
         std::isfinite(box.bottom);
}

double shared_area(const ImageBox& a, const ImageBox& b) {
  const ImageBox shared{std::max(a.left, b.left), std::max(a.top, b.top),
                        std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
  return shared.area();
}

double quantile(std::vector<double>& values, double share) {
  const auto place =
      static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

// The outermost values near the quantiles: quantiles alone would cut off limbs.
Interval robust_range(std::vector<double>& values, const AssociationConfig& config) {
  const double low = quantile(values, config.trimmed_ratio);
  const double high = quantile(values, 1.0 - config.trimmed_ratio);
  const double tail = config.tail_ratio * (high - low);
  Interval range{low, high};
  for (const double value : values) {
    if (value < low - tail || value > high + tail) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range;
}

// Over the box's diagonal.
double centre_distance(const ImageBox& cluster, const ImageBox& box) {
  const double dx = 0.5 * (cluster.left + cluster.right - box.left - box.right);
  const double dy = 0.5 * (cluster.top + cluster.bottom - box.top - box.bottom);
  return std::hypot(dx, dy) / std::hypot(box.right - box.left, box.bottom - box.top);
}

// A mixture of what the detector says of the box, and of not knowing.
ClassProbability weighted(const DetectedBox& box, double iou, double least) {
  ClassProbability probability = kUnknownClass;
  double sum = 0.0;
  for (const double p : box.probability) {
    if (!(p >= 0.0) || !std::isfinite(p)) return probability;
    sum += p;
  }
  if (!(sum > 0.0)) return probability;
  const double trust = std::clamp(box.score * iou, 0.0, 1.0);
  double all = 0.0;
  for (std::size_t i = 0; i < probability.size(); ++i) {
    probability[i] = trust * box.probability[i] / sum + (1.0 - trust) * kEven;
    all += probability[i] = std::max(probability[i], least);
  }
  for (double& p : probability) p /= all;
  return probability;
}

}  // namespace

std::optional<ClusterBox> project_cluster(std::span<const Eigen::Vector3f> points,
                                          const CameraModel& camera,
                                          const AssociationConfig& config) {
  std::vector<double> columns;
  std::vector<double> rows;
  std::vector<double> depths;
  ClusterBox cluster;
  for (const Eigen::Vector3f& p : points) {
    if (!p.allFinite()) continue;
    const std::optional<Eigen::Vector2d> pixel = camera.pixel(p.cast<double>());
    if (!pixel || !pixel->allFinite()) continue;
    columns.push_back(pixel->x());
    rows.push_back(pixel->y());
    depths.push_back(p.cast<double>().head<2>().norm());
    cluster.points_count += pixel->x() >= 0.0 && pixel->x() < camera.width_px &&
                            pixel->y() >= 0.0 && pixel->y() < camera.height_px;
  }
  if (cluster.points_count < std::max(1, config.least_points_count)) return std::nullopt;
  const Interval across = robust_range(columns, config);
  const Interval down = robust_range(rows, config);
  const double width = camera.width_px;
  const double height = camera.height_px;
  cluster.box = {std::clamp(across.low, 0.0, width), std::clamp(down.low, 0.0, height),
                 std::clamp(across.high, 0.0, width), std::clamp(down.high, 0.0, height)};
  cluster.depth_m = quantile(depths, 0.5);
  return cluster;
}

double box_overlap(const ImageBox& a, const ImageBox& b) {
  const double both = shared_area(a, b);
  const double either = a.area() + b.area() - both;
  return either > 0.0 ? both / either : 0.0;
}

namespace {

using Clusters = std::span<const std::optional<ClusterBox>>;

// Whether something nearer covers so much of the cluster that a box there is hardly the cluster's.
bool is_covered(Clusters clusters, std::size_t own, double most) {
  const ClusterBox& cluster = *clusters[own];
  const double area = std::max(cluster.box.area(), 1e-9);
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    if (i == own || !clusters[i] || clusters[i]->depth_m >= cluster.depth_m) continue;
    if (shared_area(clusters[i]->box, cluster.box) >= most * area) return true;
  }
  return false;
}

PairCosts costs_of(Clusters clusters, std::span<const DetectedBox> boxes,
                   const AssociationConfig& config) {
  // Off all costs, so that as many pairs as possible are made.
  const double any_pair = 10.0 * (1.0 + config.centre_weight);
  PairCosts costs;
  costs.reset(static_cast<int>(clusters.size()), static_cast<int>(boxes.size()));
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    if (!clusters[c] || is_covered(clusters, c, config.depth_order_ratio)) continue;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      const DetectedBox& box = boxes[b];
      if (!is_finite(box.box) || !(box.score >= config.least_score_ratio)) continue;
      const double iou = box_overlap(clusters[c]->box, box.box);
      if (!(iou > 0.0) || iou < config.least_iou_ratio) continue;
      costs.at(static_cast<int>(c), static_cast<int>(b)) =
          1.0 - iou + config.centre_weight * centre_distance(clusters[c]->box, box.box) - any_pair;
    }
  }
  return costs;
}

}  // namespace

Association associate_boxes(Clusters clusters, std::span<const DetectedBox> boxes,
                            const AssociationConfig& config) {
  PairAssignment assignment;
  const std::span<const int> found = assignment.solve(costs_of(clusters, boxes, config));
  Association association;
  association.box_of.assign(found.begin(), found.end());
  association.overlap.assign(clusters.size(), 0.0);
  association.probability.assign(clusters.size(), kUnknownClass);
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    if (found[c] < 0) continue;
    const DetectedBox& box = boxes[static_cast<std::size_t>(found[c])];
    association.overlap[c] = box_overlap(clusters[c]->box, box.box);
    association.probability[c] = weighted(box, association.overlap[c], config.missing_ratio);
  }
  return association;
}

}  // namespace headland
