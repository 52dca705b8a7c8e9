// SPDX-License-Identifier: Apache-2.0
#include "perception/detection/lidar_classifier.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"
#include "perception/tracking/detection.hpp"

namespace headland {
namespace {

// A body from one side: means and standard deviations [m].
struct Look {
  ObjectClass object;
  double weight;  // among the looks of its class
  double height;
  double height_spread;
  double extent;
  double extent_spread;
};

// Adults and children; ewes are 0.6 to 0.9 m high at the back and 1.1 m long, cows 1.3 to 1.5 m and
// 2.2 to 2.5 m; raised heads are higher. Utility vehicles to tractors.
constexpr Look kLooks[] = {
    {ObjectClass::kPerson, 0.8, 1.70, 0.15, 0.55, 0.15},
    {ObjectClass::kPerson, 0.2, 1.20, 0.20, 0.45, 0.12},
    {ObjectClass::kLivestock, 0.35, 0.85, 0.15, 1.10, 0.25},
    {ObjectClass::kLivestock, 0.15, 0.85, 0.15, 0.50, 0.15},
    {ObjectClass::kLivestock, 0.35, 1.50, 0.20, 2.20, 0.40},
    {ObjectClass::kLivestock, 0.15, 1.50, 0.20, 0.80, 0.15},
    {ObjectClass::kVehicle, 0.5, 1.90, 0.45, 3.90, 1.00},
    {ObjectClass::kVehicle, 0.25, 1.90, 0.45, 1.80, 0.30},
    {ObjectClass::kVehicle, 0.25, 2.70, 0.35, 4.00, 1.20},
};
constexpr double kOtherDensity = 1.0 / (4.0 * 8.0);  // up to 4 m high and 8 m long [1/m2]

double normal_density(double value, double mean, double spread) {
  const double z = (value - mean) / spread;
  return std::exp(-0.5 * z * z) / (spread * std::sqrt(2.0 * kPi));
}

// Of the points that fit on its upright side, how many there are; foliage has few.
double fullness(const BodyShape& shape, const LidarClassifierConfig& config) {
  const double ring = shape.range_m * deg_to_rad(config.ring_step_deg);
  const double shot = shape.range_m * deg_to_rad(config.azimuth_step_deg);
  const double fitting =
      shape.height_m / std::max(ring, 1e-3) * shape.extent_m / std::max(shot, 1e-3);
  return shape.points_count / std::max(fitting, 1.0);
}

}  // namespace

ClassProbability classify_shape(const BodyShape& shape, const LidarClassifierConfig& config) {
  const bool is_known = std::isfinite(shape.height_m) && std::isfinite(shape.extent_m) &&
                        std::isfinite(shape.speed_mps) && std::isfinite(shape.range_m) &&
                        shape.height_m > 0.0 && shape.extent_m > 0.0 && shape.points_count > 0;
  if (!is_known) return kUnknownClass;
  // The top lies somewhere below the first ring that misses it; edges likewise.
  const double top = shape.range_m * deg_to_rad(config.ring_step_deg) / std::sqrt(12.0);
  const double edge = shape.range_m * deg_to_rad(config.azimuth_step_deg);
  ClassProbability probability{};
  for (const Look& look : kLooks) {
    probability[static_cast<std::size_t>(look.object)] +=
        look.weight *
        normal_density(shape.height_m, look.height, std::hypot(look.height_spread, top)) *
        normal_density(shape.extent_m, look.extent, std::hypot(look.extent_spread, edge));
  }
  double& other = probability[static_cast<std::size_t>(ObjectClass::kOther)];
  other = kOtherDensity;
  if (std::abs(shape.speed_mps) > config.moving_mps) other *= config.still_ratio;
  // What is thin of points is likelier foliage.
  const double thin = std::min(1.0, fullness(shape, config) / config.fullest_ratio);
  double sum = 0.0;
  for (double& p : probability) {
    if (&p != &other) p *= thin;
    sum += p;
  }
  double raised = 0.0;
  for (double& p : probability) raised += p = std::max(p / sum, config.least_ratio);
  for (double& p : probability) p /= raised;
  return probability;
}

}  // namespace headland
