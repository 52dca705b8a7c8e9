// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/geometry/path.hpp"
#include "core/model/kinematics.hpp"

namespace headland {

/// A path with the speed wanted on each of its legs.
struct Reference {
  Path path;
  std::vector<double> leg_speed;  ///< [m/s], one per leg number of the path
};

enum class TrackStatus { kTracking, kGearChange, kDone, kPathLost };

struct TrackOutput {
  Command command;
  TrackStatus status = TrackStatus::kTracking;
  double s = 0.0;  ///< progress along the reference [m]
};

/// Turns a reference and a measured state into commands, tick by tick. Ticks do not allocate and do
/// not throw; any failure is a stop command with a status.
class Tracker {
 public:
  virtual ~Tracker() = default;
  /// Starts on a new reference, which must outlive its use.
  void start(const Reference& reference) {
    reference_ = &reference;
    do_start();
  }
  /// One tick of `dt` [s].
  TrackOutput step(const VehicleState& measured, double dt) {
    return reference_ == nullptr ? TrackOutput{{}, TrackStatus::kPathLost, 0.0}
                                 : do_step(measured, dt);
  }

 protected:
  const Reference& reference() const { return *reference_; }
  virtual void do_start() = 0;
  virtual TrackOutput do_step(const VehicleState& measured, double dt) = 0;

 private:
  const Reference* reference_ = nullptr;
};

}  // namespace headland
