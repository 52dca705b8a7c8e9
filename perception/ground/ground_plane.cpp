// SPDX-License-Identifier: Apache-2.0
#include "perception/ground/ground_plane.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "core/base/random.hpp"
#include "core/geometry/angle.hpp"

namespace headland {
namespace {

using Points = std::vector<Eigen::Vector3f>;

struct Plane {
  Eigen::Vector3f normal;
  float offset;
};

// Points that the ground could pass through: near, below half the sensor, above what the steepest
// plane allowed reaches.
Points candidates(std::span<const LidarPoint> points, const GroundPlaneConfig& config,
                  const Eigen::Vector3f& up) {
  Points found;
  found.reserve(points.size());
  const auto reach2 = static_cast<float>(config.reach_m * config.reach_m);
  const auto highest = static_cast<float>(0.5 * config.sensor_height_m);
  const auto steepest = static_cast<float>(std::tan(deg_to_rad(config.axis_tolerance_deg)));
  const auto lowest = static_cast<float>(-2.0 * config.height_tolerance_m);
  for (const LidarPoint& point : points) {
    const float height = up.dot(point.position);
    const float far2 = point.position.squaredNorm() - height * height;
    if (!(far2 <= reach2 && height < highest)) continue;  // NaN too
    if (height < lowest - steepest * std::sqrt(std::max(far2, 0.0f))) continue;
    found.push_back(point.position);
  }
  return found;
}

// The lowest candidate of each square metre: where plants stand over the ground, the ground.
Points lowest(const Points& points, const GroundPlaneConfig& config, const Eigen::Vector3f& up) {
  const int half = static_cast<int>(std::ceil(config.reach_m * 1.5 / config.cell_m)) + 1;
  const auto per_metre = static_cast<float>(1.0 / config.cell_m);
  const auto width = static_cast<std::size_t>(2 * half);
  std::vector<int> lowest_of(width * width, -1);
  for (int i = 0; i < std::ssize(points); ++i) {
    const Eigen::Vector3f& p = points[static_cast<std::size_t>(i)];
    const int column = static_cast<int>(std::floor(p.x() * per_metre)) + half;
    const int row = static_cast<int>(std::floor(p.y() * per_metre)) + half;
    if (column < 0 || row < 0 || column >= 2 * half || row >= 2 * half) continue;
    int& best = lowest_of[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)];
    if (best < 0 || up.dot(p) < up.dot(points[static_cast<std::size_t>(best)])) best = i;
  }
  Points found;
  for (const int i : lowest_of) {
    if (i >= 0) found.push_back(points[static_cast<std::size_t>(i)]);
  }
  return found;
}

class Judge {
 public:
  Judge(const GroundPlaneConfig& config, const Eigen::Vector3f& up)
      : up_(up),
        least_cosine_(static_cast<float>(std::cos(deg_to_rad(config.axis_tolerance_deg)))),
        most_height_(static_cast<float>(config.height_tolerance_m)),
        band_(static_cast<float>(config.inlier_m)) {}

  bool allows(const Plane& plane) const {
    return plane.normal.dot(up_) >= least_cosine_ && std::abs(plane.offset) <= most_height_;
  }
  bool on(const Plane& plane, const Eigen::Vector3f& p) const {
    return std::abs(plane.normal.dot(p) + plane.offset) <= band_;
  }
  int inliers(const Plane& plane, const Points& points) const {
    int count = 0;
    for (const Eigen::Vector3f& p : points) count += on(plane, p) ? 1 : 0;
    return count;
  }
  // Inliers, less those that would lie in the ground.
  int score(const Plane& plane, const Points& points) const {
    int sum = 0;
    for (const Eigen::Vector3f& p : points) {
      const float height = plane.normal.dot(p) + plane.offset;
      sum += std::abs(height) <= band_ ? 1 : 0;
      sum -= height < -2.0f * band_ ? 1 : 0;
    }
    return sum;
  }

 private:
  Eigen::Vector3f up_;
  float least_cosine_;
  float most_height_;
  float band_;
};

Plane through(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
              const Eigen::Vector3f& up) {
  Eigen::Vector3f normal = (b - a).cross(c - a);
  const float length = normal.norm();
  if (!(length > 1e-6f)) return {Eigen::Vector3f::Zero(), 0.0f};
  normal /= normal.dot(up) < 0.0f ? -length : length;
  return {normal, -normal.dot(a)};
}

// Triples enough to have found one of inliers alone, with 99 % probability.
int triples_for(double inlier_ratio) {
  const double all_three = std::pow(std::clamp(inlier_ratio, 1e-3, 0.999), 3);
  return static_cast<int>(std::ceil(std::log(0.01) / std::log(1.0 - all_three)));
}

Plane best_of_triples(const Points& points, const GroundPlaneConfig& config, const Judge& judge,
                      const Eigen::Vector3f& up) {
  RandomStream random(static_cast<std::uint64_t>(config.seed_count), "ground_plane");
  const int count = static_cast<int>(points.size());
  Plane best{Eigen::Vector3f::Zero(), 0.0f};
  int best_score = 0;
  int most = config.iterations_count;
  for (int i = 0; i < most; ++i) {
    const auto pick = [&]() -> const Eigen::Vector3f& {
      return points[static_cast<std::size_t>(random.index(count))];
    };
    const Eigen::Vector3f& a = pick();
    const Eigen::Vector3f& b = pick();
    const Plane plane = through(a, b, pick(), up);
    if (!judge.allows(plane)) continue;
    const int score = judge.score(plane, points);
    if (score <= best_score) continue;
    best = plane;
    best_score = score;
    most = std::min(config.iterations_count, 3 * triples_for(static_cast<double>(score) / count));
  }
  return best;
}

// Least squares (total) on the points that lie on `plane`; the same plane where they are too few,
// or all on a line.
Plane refined(const Plane& plane, const Points& points, const Judge& judge,
              const Eigen::Vector3f& up) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int count = 0;
  for (const Eigen::Vector3f& point : points) {
    if (!judge.on(plane, point)) continue;
    const Eigen::Vector3d p = point.cast<double>();
    sum += p;
    squares.noalias() += p * p.transpose();
    ++count;
  }
  if (count < 3) return plane;
  const Eigen::Vector3d mean = sum / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares / count -
                                                            mean * mean.transpose());
  constexpr double kThinnest = 0.01;  // [m2], across: 0.1 m
  if (!(axes.eigenvalues()[1] > kThinnest)) return plane;
  Eigen::Vector3d normal = axes.eigenvectors().col(0);
  if (normal.dot(up.cast<double>()) < 0.0) normal = -normal;
  return {normal.cast<float>(), static_cast<float>(-normal.dot(mean))};
}

// Whether the points on the plane spread both ways: those of a line fit many planes.
bool is_spread(const Plane& plane, const Points& points, const Judge& judge) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  int count = 0;
  for (const Eigen::Vector3f& p : points) {
    if (!judge.on(plane, p)) continue;
    const Eigen::Vector2d place = p.head<2>().cast<double>();
    sum += place;
    squares.noalias() += place * place.transpose();
    ++count;
  }
  const Eigen::Vector2d mean = sum / std::max(count, 1);
  const Eigen::Matrix2d spread = squares / std::max(count, 1) - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread, Eigen::EigenvaluesOnly);
  constexpr double kNarrowest = 0.3;  // [m], standard deviation
  return axes.eigenvalues()[0] > kNarrowest * kNarrowest;
}

}  // namespace

GroundPlane fit_ground_plane(std::span<const LidarPoint> points_base,
                             const GroundPlaneConfig& config, const Eigen::Vector3d& up_base) {
  const Eigen::Vector3f up = up_base.cast<float>();
  const Points low = candidates(points_base, config, up);
  if (std::ssize(low) < config.least_points_count) return {};

  const Judge judge(config, up);
  Plane plane = best_of_triples(lowest(low, config, up), config, judge, up);
  if (!judge.allows(plane)) return {};
  for (int round = 0; round < 3; ++round) {
    const Plane better = refined(plane, low, judge, up);
    if (judge.score(better, low) < judge.score(plane, low)) break;
    plane = better;
  }

  const int inliers = judge.inliers(plane, low);
  GroundPlane ground;
  ground.inlier_ratio = static_cast<double>(inliers) / static_cast<double>(low.size());
  ground.valid = judge.allows(plane) && inliers >= config.least_points_count &&
                 ground.inlier_ratio >= config.least_inlier_ratio && is_spread(plane, low, judge) &&
                 plane.normal.z() > 0.0f;
  if (!ground.valid) return ground;
  ground.normal = plane.normal.cast<double>().normalized();
  ground.offset_m = static_cast<double>(plane.offset);
  return ground;
}

}  // namespace headland
