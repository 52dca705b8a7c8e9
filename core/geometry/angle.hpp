// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace headland {

inline constexpr double kPi = std::numbers::pi;

/// Wraps an angle [rad] to (-pi, pi]. The only place that wraps.
double wrap_angle(double angle);

/// Wraps an angle [rad] to [0, 2 pi); values within `snap` below 2 pi become 0, so that a turn of
/// nothing never becomes a full circle.
double wrap_positive(double angle, double snap = 0.0);

constexpr double deg_to_rad(double degrees) { return degrees * kPi / 180.0; }
constexpr double rad_to_deg(double radians) { return radians * 180.0 / kPi; }

}  // namespace headland
