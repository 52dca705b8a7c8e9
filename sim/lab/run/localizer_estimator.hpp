// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/estimation/estimator.hpp"
#include "core/model/vehicle.hpp"
#include "perception/localization/localizer.hpp"

namespace headland {

/// The localizer as an estimator for trackers: poses from GNSS, wheels, gyroscope and, where they
/// are added, lidar scans and inertial readings. It tells no slip. One gyroscope counts: once
/// inertial readings come, measured yaw rates are left out. Late and refused measurements are those
/// that the localizer's filters do not use.
class LocalizerEstimator : public Estimator {
 public:
  LocalizerEstimator(const Vehicle& vehicle, LocalizerConfig config);

  void reset(const VehicleState& start, double now) override;
  Estimate update(std::span<const Measurement> measured, const Command& last, double now) override;

  void add(const ImuReading& reading);
  void add(const LidarScan& scan) { localizer_.add(scan); }

 private:
  void add(const Measurement& reading);

  Vehicle vehicle_;
  Localizer localizer_;
  Estimate estimate_;
  bool inertial_ = false;  // readings come
};

}  // namespace headland
