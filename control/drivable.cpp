// SPDX-License-Identifier: Apache-2.0
#include "control/drivable.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace headland {
namespace {

constexpr double kSlackRatio = 1e-3;  // of the curvature: rounding of planners

}  // namespace

std::optional<Error> check_curvature(const Vehicle& vehicle, const Path& path, double most_angle) {
  if (vehicle.steering != Steering::kAckermann) return std::nullopt;
  const double most = std::tan(most_angle) / vehicle.wheelbase_m;
  double s = 0.0;
  for (const PathPiece& piece : path.pieces()) {
    const double bend = std::max(std::abs(piece.curvature), std::abs(piece.end_curvature()));
    if (!(bend <= most * (1.0 + kSlackRatio))) {
      return Error{ErrorCode::kPathTooTight,
                   fmt::format("the path turns on {:.2f} m after {:.1f} m, and the vehicle steers "
                               "{:.1f} degrees: {:.2f} m at best",
                               1.0 / bend, s, rad_to_deg(most_angle), 1.0 / most),
                   "plan with a larger min_turning_radius_m, or allow more steering",
                   {}};
    }
    s += piece.length;
  }
  return std::nullopt;
}

double longest_steering(const Vehicle& vehicle) {
  return 2.0 * vehicle.max_steering_rad() / vehicle.steering_rate_radps +
         10.0 * vehicle.steering_lag_s + vehicle.steering_dead_time_s + 0.5;
}

}  // namespace headland
