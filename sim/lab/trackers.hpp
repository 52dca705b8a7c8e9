// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "control/tracker.hpp"
#include "sim/simulated_vehicle.hpp"

namespace headland {

/// The tracker that suits a vehicle: pure pursuit for Ackermann, the rover tracker for differential
/// kinematics, with its position filter told how good the fixes are.
std::unique_ptr<Tracker> make_tracker(const Vehicle& vehicle, const SensorConfig& sensors);

}  // namespace headland
