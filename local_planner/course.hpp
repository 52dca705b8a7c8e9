// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "local_planner/local_planner.hpp"
#include "local_planner/rollout.hpp"

namespace headland {

/// What the vehicle steers for while it follows the global path.
struct Aim {
  Point2 point{0.0, 0.0};  ///< a lookahead along the path, or the place itself [m, map]
  Gear gear = Gear::kForward;
  double left = 0.0;      ///< to where the vehicle must stand: a cusp, the path's end or, without a
                          ///< path, the place [m]; negative: it is past that
  double accuracy = 1e3;  ///< how near to the point it is to come [m]; large: it is a direction
};

/// Progress along a goal's path while a plan is rolled out. The aim never lies past a cusp. It is
/// the place itself where the path does not lead there: without a path, and where the vehicle has
/// left the path by more than half of the accuracy or has passed the place without reaching it.
/// Does not allocate; `goal` and its path must outlive it.
class Course {
 public:
  explicit Course(const LocalGoal& goal);

  /// The aim from a state; to be called state by state of a rollout.
  Aim from(const VehicleState& state, double lookahead);

 private:
  bool steers_for_place(const Point2& position, double lateral, double lookahead);

  const LocalGoal& goal_;
  const Path* path_;  // null: none
  double s_ = 0.0;    // progress along it [m]
  std::size_t segment_ = 0;
  double place_s_ = -1.0;  // of the place on the path [m]; negative: not near
  bool reached_ = false;   // the place, in the course of the rollout
};

/// The motion that pursues an aim (pure pursuit, Coulter 1992), at most at `speed` [m/s]: slower in
/// curves and before a stop. A place inside the turning circle is driven away from until it can be
/// reached: backwards if the vehicle can. A differential vehicle turns on the spot towards an aim
/// that lies aside.
Motion pursue(const Vehicle& vehicle, const VehicleState& state, const Aim& aim, double speed);

}  // namespace headland
