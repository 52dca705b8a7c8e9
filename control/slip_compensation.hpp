// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "control/tracker.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

/// Makes any tracker slip-aware: it shows the tracker the vehicle without slip that moves as this
/// one does (heading turned into the direction of travel, ground speed, effective steering), and
/// turns its commands back. With no slip known, it changes nothing.
class SlipCompensation : public Tracker {
 public:
  SlipCompensation(const Vehicle& vehicle, std::unique_ptr<Tracker> tracker)
      : vehicle_(vehicle), tracker_(std::move(tracker)) {}

 private:
  Result<void> do_start() override { return tracker_->start(reference()); }
  TrackOutput do_step(const VehicleEstimate& estimate, double dt) override;

  Vehicle vehicle_;
  std::unique_ptr<Tracker> tracker_;
};

}  // namespace headland
