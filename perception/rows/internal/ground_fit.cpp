// SPDX-License-Identifier: Apache-2.0
#include "perception/rows/internal/ground_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "core/base/random.hpp"

namespace headland::internal {
namespace {

constexpr double kSlopeReach = 0.25;  // candidates may rise or fall so much per metre away
constexpr int kReachCells = 20;       // of a metre each, to every side
constexpr double kNothing = 1e9;
constexpr std::uint64_t kSeed = 7;

bool is_allowed(const FittedPlane& plane, const PlaneFitConfig& config) {
  return plane.normal.z() >= std::cos(config.steepest_rad) &&
         std::abs(plane.constant_m) <= config.height_prior_m;
}

std::optional<FittedPlane> plane_through(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                         const Eigen::Vector3d& c) {
  Eigen::Vector3d normal = (b - a).cross(c - a);
  const double norm = normal.norm();
  if (!(norm > 1e-6)) return std::nullopt;
  normal /= norm;
  if (normal.z() < 0.0) normal = -normal;
  return FittedPlane{normal, -normal.dot(a), 0};
}

// Counts inliers into the plane; gives its score.
double score(FittedPlane& plane, std::span<const Eigen::Vector3d> points,
             const PlaneFitConfig& config) {
  int below = 0;
  plane.inliers = 0;
  for (const Eigen::Vector3d& p : points) {
    const double height = plane.height(p);
    plane.inliers += std::abs(height) <= config.inlier_m ? 1 : 0;
    below += height < -2.0 * config.inlier_m ? 1 : 0;
  }
  return plane.inliers - config.below_weight * below;
}

FittedPlane refined(const FittedPlane& plane, std::span<const Eigen::Vector3d> points,
                    double tolerance) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Eigen::Vector3d& p : points) {
    if (std::abs(plane.height(p)) > tolerance) continue;
    mean += p;
    ++count;
  }
  if (count < 3) return plane;
  mean /= count;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) {
    if (std::abs(plane.height(p)) > tolerance) continue;
    scatter += (p - mean) * (p - mean).transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scatter);
  Eigen::Vector3d normal = solver.eigenvectors().col(0).normalized();
  if (normal.z() < 0.0) normal = -normal;
  if (!normal.allFinite()) return plane;
  return {normal, -normal.dot(mean), count};
}

}  // namespace

std::optional<FittedPlane> fit_plane(std::span<const Eigen::Vector3d> points,
                                     const PlaneFitConfig& config, std::uint64_t seed) {
  const int size = static_cast<int>(points.size());
  if (size < std::max(3, config.least_inliers)) return std::nullopt;
  RandomStream random(seed, "ground");
  FittedPlane best;
  double best_score = 0.0;
  const auto drawn = [&] { return points[static_cast<std::size_t>(random.index(size))]; };
  for (int i = 0; i < config.iterations; ++i) {
    const Eigen::Vector3d a = drawn();
    const Eigen::Vector3d b = drawn();
    auto plane = plane_through(a, b, drawn());
    if (!plane || !is_allowed(*plane, config)) continue;
    const double plane_score = score(*plane, points, config);
    if (plane_score <= best_score) continue;
    best_score = plane_score;
    best = *plane;
  }
  if (best.inliers < std::max(3, config.least_inliers)) return std::nullopt;
  const bool is_limited = std::isfinite(config.height_prior_m);
  if (!is_limited) return best;
  for (int pass = 0; pass < 2; ++pass) {
    const FittedPlane better = refined(best, points, config.inlier_m);
    if (is_allowed(better, config)) best = better;
  }
  return best;
}

std::optional<FittedPlane> fit_ground(std::span<const LidarPoint> points_base,
                                      const PlaneFitConfig& config,
                                      std::vector<Eigen::Vector3d>& scratch) {
  constexpr int kSide = 2 * kReachCells;
  const Eigen::Vector3d nothing = Eigen::Vector3d::Constant(kNothing);
  scratch.assign(static_cast<std::size_t>(kSide) * kSide, nothing);
  for (const LidarPoint& point : points_base) {
    const Eigen::Vector3f& p = point.position;
    const float x = p.x() + kReachCells;
    const float y = p.y() + kReachCells;
    if (!(x >= 0.0f && x < kSide && y >= 0.0f && y < kSide)) continue;
    const double reach = config.height_prior_m + kSlopeReach * std::hypot(p.x(), p.y());
    if (!(std::abs(p.z()) <= reach)) continue;
    Eigen::Vector3d& lowest =
        scratch[static_cast<std::size_t>(x) * kSide + static_cast<std::size_t>(y)];
    if (p.z() < lowest.z()) lowest = p.cast<double>();
  }
  std::erase_if(scratch, [](const Eigen::Vector3d& p) { return p.z() == kNothing; });
  return fit_plane(scratch, config, kSeed);
}

}  // namespace headland::internal
