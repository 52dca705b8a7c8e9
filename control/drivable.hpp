// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/base/error.hpp"
#include "core/geometry/path.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

/// Error kPathTooTight where the path bends more than an Ackermann vehicle can steer with angles up
/// to `most_angle` [rad]; it names the place and both radii. A differential vehicle can drive any
/// path.
std::optional<Error> check_curvature(const Vehicle& vehicle, const Path& path, double most_angle);

/// How long the wheels may take from lock to lock [s], with some to spare: longer, and they are
/// stuck.
double longest_steering(const Vehicle& vehicle);

}  // namespace headland
