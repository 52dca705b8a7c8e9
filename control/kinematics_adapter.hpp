// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "control/tracker.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

/// Lets a tracker for the one kind of kinematics drive a vehicle of the other. An Ackermann vehicle
/// steers the curvature that a differential tracker's yaw rate means; a differential vehicle
/// follows a steering angle that is turned in its stead, as fast as `twin()` can. An Ackermann
/// vehicle cannot turn on the spot: told to, it stands.
class KinematicsAdapter : public Tracker {
 public:
  /// `tracker` was made for twin(vehicle).
  KinematicsAdapter(const Vehicle& vehicle, std::unique_ptr<Tracker> tracker)
      : vehicle_(vehicle), twin_(twin(vehicle)), tracker_(std::move(tracker)) {}

  /// The same vehicle with the other kinematics.
  static Vehicle twin(const Vehicle& vehicle);

 private:
  Result<void> do_start() override;
  TrackOutput do_step(const VehicleEstimate& estimate, double dt) override;

  Vehicle vehicle_;
  Vehicle twin_;
  std::unique_ptr<Tracker> tracker_;
  double angle_ = 0.0;  // of the steering that a differential vehicle does not have [rad]
};

}  // namespace headland
