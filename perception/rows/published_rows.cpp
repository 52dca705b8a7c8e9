// SPDX-License-Identifier: Apache-2.0
// (000) III-A. d: distance to the ground, n: its normal, m, b, s: the parallel lines of Eq. 2.
#include "perception/rows/published_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "perception/rows/internal/euclidean_clusters.hpp"
#include "perception/rows/internal/ground_fit.hpp"
#include "perception/rows/internal/line_motion.hpp"

namespace headland {
namespace {

using Points2 = std::vector<Eigen::Vector2d>;

constexpr std::uint64_t kSeed = 1;
constexpr double kPointNoise = 0.1;  // of a thinned point about its line [m]

struct ParallelLines {
  double m = 0.0;
  double b = 0.0;
  double s = 0.0;
  double variance_m = 0.0;
  std::array<double, 2> variance_b{};
};

std::vector<Eigen::Vector3d> usable_points(const std::vector<LidarPoint>& points, double far) {
  std::vector<Eigen::Vector3d> usable;
  usable.reserve(points.size());
  for (const LidarPoint& point : points) {
    const Eigen::Vector3d p = point.position.cast<double>();
    if (p.allFinite() && p.head<2>().norm() <= far) usable.push_back(p);
  }
  return usable;
}

// Eq. 1 for the points in the band, then one point per voxel, the mean.
Points2 projected_band(const std::vector<Eigen::Vector3d>& points,
                       const internal::FittedPlane& ground, const PublishedRowsConfig& config) {
  std::map<std::array<std::int64_t, 2>, Eigen::Vector3d> voxels;  // sum of x, of y, count
  for (const Eigen::Vector3d& p : points) {
    const double d = ground.height(p);
    if (d < config.low_m || d > config.high_m) continue;
    const Eigen::Vector3d projected = p - d * ground.normal;
    const auto index = [&](double value) {
      return static_cast<std::int64_t>(std::floor(value / config.voxel_m));
    };
    auto& voxel =
        voxels.try_emplace({index(projected.x()), index(projected.y())}, Eigen::Vector3d::Zero())
            .first->second;
    voxel += Eigen::Vector3d(projected.x(), projected.y(), 1.0);
  }
  Points2 thinned;
  for (const auto& [cell, sum] : voxels) thinned.push_back(sum.head<2>() / sum.z());
  return thinned;
}

// The two clusters with the most points.
std::array<Points2, 2> two_densest(const Points2& points, double tolerance) {
  std::vector<Points2> clusters;
  const std::vector<int> label = internal::euclidean_clusters(points, tolerance);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto cluster = static_cast<std::size_t>(label[i]);
    if (cluster >= clusters.size()) clusters.resize(cluster + 1);
    clusters[cluster].push_back(points[i]);
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const Points2& a, const Points2& b) { return a.size() > b.size(); });
  clusters.resize(std::max<std::size_t>(clusters.size(), 2));
  return {clusters[0], clusters[1]};
}

// Eq. 2 in closed form: m = sum Sxy / sum Sxx over both clusters.
std::optional<ParallelLines> fit_parallel(const std::array<Points2, 2>& walls) {
  std::array<Eigen::Vector2d, 2> mean;
  double sxx = 0.0;
  double sxy = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (walls[i].size() < 3) return std::nullopt;
    mean[i].setZero();
    for (const auto& p : walls[i]) mean[i] += p / static_cast<double>(walls[i].size());
    for (const auto& p : walls[i]) {
      sxx += (p.x() - mean[i].x()) * (p.x() - mean[i].x());
      sxy += (p.x() - mean[i].x()) * (p.y() - mean[i].y());
    }
  }
  if (!(sxx > 1e-6)) return std::nullopt;
  ParallelLines lines;
  lines.m = sxy / sxx;
  lines.b = mean[0].y() - lines.m * mean[0].x();
  lines.s = mean[1].y() - lines.m * mean[1].x() - lines.b;
  lines.variance_m = kPointNoise * kPointNoise / sxx;
  for (std::size_t i = 0; i < 2; ++i) {
    lines.variance_b[i] = kPointNoise * kPointNoise / static_cast<double>(walls[i].size()) +
                          mean[i].x() * mean[i].x() * lines.variance_m;
  }
  return lines;
}

RowEstimate lane_between(const ParallelLines& lines) {
  RowEstimate lane;
  lane.heading_rad = std::atan(lines.m);
  const double upright = std::cos(lane.heading_rad);  // perpendicular to the lines, from along y
  const double first = lines.b * upright;
  const double second = (lines.b + lines.s) * upright;
  lane.left_m = std::max(first, second);
  lane.right_m = std::min(first, second);
  lane.offset_m = 0.5 * (lane.left_m + lane.right_m);
  lane.width_m = lane.left_m - lane.right_m;
  const double both = lines.variance_b[0] + lines.variance_b[1];
  lane.covariance.diagonal() << 0.25 * both, lines.variance_m, both;
  return lane;
}

RowEstimate abstain(RowStatus status) {
  RowEstimate nothing;
  nothing.status = status;
  return nothing;
}

}  // namespace

RowEstimate PublishedRows::update(const std::vector<LidarPoint>& points_base, const Pose2& moved,
                                  double time_s) {
  if (!std::isfinite(time_s) || (last_ && time_s < last_time_s_)) {
    return abstain(RowStatus::kTimeBackwards);
  }
  if (last_) internal::move_lane(*last_, moved);
  const auto points = usable_points(points_base, config_.far_m);
  if (points.size() < 3) return abstain(RowStatus::kNoPoints);
  internal::PlaneFitConfig plane;
  plane.iterations = config_.ground_iterations_count;
  plane.inlier_m = config_.ground_inlier_m;
  plane.steepest_rad = kPi;
  plane.height_prior_m = std::numeric_limits<double>::infinity();
  const auto ground = internal::fit_plane(points, plane, kSeed);
  if (!ground) return abstain(RowStatus::kNoGround);
  const Points2 band = projected_band(points, *ground, config_);
  const auto lines = fit_parallel(two_densest(band, config_.cluster_m));
  if (!lines) return abstain(RowStatus::kNoLane);
  RowEstimate lane = lane_between(*lines);
  const bool is_remembered = last_ && time_s - last_time_s_ <= config_.forget_s;
  const bool is_near =
      !is_remembered ||
      (std::abs(lane.offset_m - last_->offset_m) <= config_.distance_gate_m &&
       std::abs(lane.heading_rad - last_->heading_rad) <= deg_to_rad(config_.orientation_gate_deg));
  if (!is_near) return abstain(RowStatus::kJump);
  if (!(lane.left_m > 0.0 && lane.right_m < 0.0)) return abstain(RowStatus::kNoLane);
  if (std::abs(lane.width_m - row_width_m_) > config_.width_tolerance_m) {
    return abstain(RowStatus::kWidthOff);
  }
  lane.sides = RowSides::kBoth;
  lane.valid = true;
  lane.status = RowStatus::kValid;
  last_ = lane;
  last_time_s_ = time_s;
  return lane;
}

}  // namespace headland
