// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/clock.hpp"
#include "sim/lab/crowd/robot.hpp"
#include "sim/lab/crowd/scenario.hpp"

namespace headland {

/// How an episode went. Counts are doubles, as they are stored with the rest.
struct CrowdOutcome {
  double people_count = 0.0;
  double success_count = 0.0;    ///< 1: the goal was reached in time, without collision
  double collision_count = 0.0;  ///< 1: robot and a person touched
  double fault_count = 0.0;      ///< 1: and the robot drove towards the person
  double time_s = 0.0;           ///< until the end, whatever it was
  double length_m = 0.0;         ///< driven
  double gap_m = 0.0;            ///< least distance of outlines, below 0 in a collision
  double near_count = 0.0;       ///< steps that came nearer than the protocol's near miss
  double seen_count = 0.0;       ///< steps of people near the robot, and of these ...
  double disturbed_count = 0.0;  ///< ... those that change velocity by the protocol's disturbance,
  double disturbed_half_count = 0.0;     ///< by half of it,
  double disturbed_quarter_count = 0.0;  ///< by a quarter

  /// All of them, in order, with the names of their columns.
  template <class V>
  void visit(V& v) {
    v("people_count", people_count);
    v("success_count", success_count);
    v("collision_count", collision_count);
    v("fault_count", fault_count);
    v("time_s", time_s);
    v("length_m", length_m);
    v("gap_m", gap_m);
    v("near_count", near_count);
    v("seen_count", seen_count);
    v("disturbed_count", disturbed_count);
    v("disturbed_half_count", disturbed_half_count);
    v("disturbed_quarter_count", disturbed_quarter_count);
  }
};

/// Drives the scenario until goal, collision or timeout; people see the robot if it is `visible`.
/// Distances are the least of the way between the steps, not only at their ends. Deterministic if
/// the robot is; `plan_ms` gets the time of each decision on `clock`.
CrowdOutcome run_crowd_episode(const CrowdScenario& scenario, bool visible, EpisodeRobot& robot,
                               const Clock& clock, std::vector<double>& plan_ms);

}  // namespace headland
