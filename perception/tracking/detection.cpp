// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/detection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace headland {
namespace {

constexpr double kFarthest = 1e7;  // [m]
constexpr int kBins = 64;          // of the depths

bool is_usable(const Point2& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthest; }

struct Spread {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  double extent() const { return most - least; }
};

}  // namespace

std::optional<Detection> detect_body(std::span<const Point2> points, const Point2& sensor,
                                     const BodyConfig& config, double width) {
  if (!is_usable(sensor)) return std::nullopt;
  Point2 sum(0.0, 0.0);
  int count = 0;
  for (const Point2& p : points) {
    if (!is_usable(p)) continue;
    sum += p;
    ++count;
  }
  if (count == 0) return std::nullopt;
  const Point2 mean = sum / count - sensor;
  const Point2 ahead = mean.norm() > 1e-6 ? Point2(mean.normalized()) : Point2(1.0, 0.0);
  const Point2 left(-ahead.y(), ahead.x());

  Spread along;
  Spread across;
  for (const Point2& p : points) {
    if (!is_usable(p)) continue;
    along.add(ahead.dot(p - sensor));
    across.add(left.dot(p - sensor));
  }
  // The quantile of the depths, by a histogram.
  std::array<int, kBins> bins{};
  const double bin = std::max(along.extent() / kBins, 1e-9);
  for (const Point2& p : points) {
    if (!is_usable(p)) continue;
    const double depth = (ahead.dot(p - sensor) - along.least) / bin;
    ++bins[static_cast<std::size_t>(std::clamp(static_cast<int>(depth), 0, kBins - 1))];
  }
  int below = 0;
  int first = 0;
  while (first < kBins - 1) {
    below += bins[static_cast<std::size_t>(first)];
    if (below >= config.near_quantile_ratio * count) break;
    ++first;
  }
  const double near_side = along.least + (first + 0.5) * bin;

  Detection body;
  body.across_m = across.extent();
  body.along_m = along.most - near_side;
  body.points_count = count;
  body.points = points;
  const double depth =
      std::max(body.along_m, std::min(std::max(body.across_m, width), config.deepest_m));
  const double range = near_side + 0.5 * depth;
  body.position = sensor + range * ahead + 0.5 * (across.least + across.most) * left;
  const double noise = config.noise_m + config.noise_ratio * std::abs(range);
  body.covariance = noise * noise * Eigen::Matrix2d::Identity();
  return body;
}

bool is_sound(const Detection& detection) {
  const auto is_fraction = [](double p) { return p >= 0.0 && p <= 1.0; };
  const Eigen::Matrix2d& c = detection.covariance;
  return is_usable(detection.position) && c.allFinite() && c(0, 0) > 0.0 && c.determinant() > 0.0 &&
         std::isfinite(detection.across_m) && std::isfinite(detection.along_m) &&
         std::isfinite(detection.height_m) &&
         std::all_of(detection.probability.begin(), detection.probability.end(), is_fraction);
}

}  // namespace headland
