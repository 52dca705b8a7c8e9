// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/path.hpp"
#include "core/model/kinematics.hpp"

namespace headland {

/// A stretch of a path that is to be driven slowly.
struct SpeedZone {
  double begin_s = 0.0;  ///< [m]
  double end_s = 0.0;    ///< [m]
  double speed = 0.0;    ///< [m/s] > 0
};

/// A path with the speed wanted on each of its legs.
struct Reference {
  Path path;
  std::vector<double> leg_speed;  ///< [m/s], one per leg number of the path
  /// Where the ground allows less (energy_zones), in the order of their begins.
  std::vector<SpeedZone> zones{};
  /// Whether the implement is at work, one per leg number; empty: nowhere.
  std::vector<bool> leg_working{};
};

enum class TrackStatus {
  kTracking,
  kGearChange,
  kDone,
  // Failures: the command is a stop.
  kPathLost,     ///< too far from the path
  kBadState,     ///< the measured state, or the cycle time, is no number
  kSolverFailed  ///< no usable plan for too long
};

constexpr bool failed(TrackStatus status) { return status >= TrackStatus::kPathLost; }

struct TrackOutput {
  Command command;
  TrackStatus status = TrackStatus::kTracking;
  double s = 0.0;      ///< progress along the reference [m]
  bool stale = false;  ///< the command is an older plan's: a new one came too late, or failed
};

/// Turns a reference and an estimated state into commands, tick by tick. Ticks do not allocate and
/// do not throw; any failure is a stop command with a status.
class Tracker {
 public:
  virtual ~Tracker() = default;
  /// Starts on a new reference, which must outlive its use. An error says what of it the vehicle
  /// cannot drive; the tracker then stands.
  Result<void> start(const Reference& reference) {
    reference_ = &reference;
    Result<void> started = do_start();
    if (!started) reference_ = nullptr;
    return started;
  }
  /// One tick of `dt` [s].
  TrackOutput step(const VehicleEstimate& estimate, double dt) {
    return reference_ == nullptr ? TrackOutput{{}, TrackStatus::kPathLost, 0.0}
                                 : do_step(estimate, dt);
  }

 protected:
  const Reference& reference() const { return *reference_; }
  virtual Result<void> do_start() = 0;
  virtual TrackOutput do_step(const VehicleEstimate& estimate, double dt) = 0;

 private:
  const Reference* reference_ = nullptr;
};

}  // namespace headland
