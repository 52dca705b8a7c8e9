// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "control/pure_pursuit/seed_pure_pursuit.hpp"

namespace headland {

/// Seed 002's controller for its fishtail run, as its authors ran it: pure pursuit on the link of
/// the nearest of all waypoints, and in a fishtail five phases by the progress from row to row. It
/// reverses only in the period in which a phase begins.
class SeedFishtailPursuit {
 public:
  struct Output {
    double steering = 0.0;  ///< [rad], saturated
    bool reverse = false;
  };

  /// `fishtails`: the links driven in phases. `route` must outlive the controller.
  SeedFishtailPursuit(const SeedPurePursuitConfig& config, const SeedRoute& route,
                      std::vector<bool> fishtails);

  Output step(const Pose2& T_map_base);

 private:
  double pursue(const Pose2& T_map_base, int index) const;
  bool next_phase(const Point2& p);
  double phase_steering(const Pose2& T_map_base, bool reverse) const;
  int first_point() const { return link_ == 0 ? 0 : route_.last_point(link_ - 1) + 1; }

  SeedPurePursuitConfig config_;
  const SeedRoute& route_;
  std::vector<bool> fishtails_;
  double limit_ = 0.0;  // [rad]
  int link_ = 0;
  int phase_ = 0;  // 1 to 5; 0: no fishtail under way
};

}  // namespace headland
