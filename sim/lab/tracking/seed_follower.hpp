// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "control/pure_pursuit/seed_pure_pursuit.hpp"
#include "control/tracker.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

/// Seed 002's pure pursuit behind the trackers' interface: waypoints as its authors lay them (every
/// 0.5 m in rows, 0.25 m in turns), a link a leg, the leg's speed throughout, done within 0.5 m of
/// the end. Knows neither slip nor reverse gear: a path with a cusp is refused.
class SeedFollower : public Tracker {
 public:
  SeedFollower(const Vehicle& vehicle, const SeedPurePursuitConfig& config);

 private:
  Result<void> do_start() override;
  TrackOutput do_step(const VehicleEstimate& estimate, double dt) override;

  Vehicle vehicle_;
  SeedPurePursuitConfig config_;
  SeedRoute route_;
  std::optional<SeedPurePursuit> pursuit_;
  double s_ = 0.0;
  bool done_ = false;
};

}  // namespace headland
