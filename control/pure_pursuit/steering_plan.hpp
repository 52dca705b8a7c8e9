// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "control/pure_pursuit/bounded_ramp.hpp"
#include "control/speed_profile.hpp"
#include "control/tracker.hpp"
#include "core/config/visit.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

struct SteeringPlanConfig {
  /// Share of the actuator's rate that the plan uses; feedback has the rest.
  double rate_use_ratio = 0.95;
  /// The plan's resolution [m].
  double step_m = 0.04;
  /// The path within this distance of a step of its curvature is planned, beside what the steering
  /// needs for the step [m].
  double margin_m = 2.0;
  /// Weight of the heading error against the lateral one, as a length [m].
  double heading_weight_m = 0.15;

  template <class V>
  void visit(V& v) {
    v("rate_use_ratio", rate_use_ratio, config::Range{0.2, 1.0},
      "Share of the steering rate that the feed-forward uses");
    v("step_m", step_m, config::Range{0.005, 0.5}, "Resolution of the steering plan [m]");
    v("margin_m", margin_m, config::Range{0.1, 20.0},
      "How far from a step of curvature the steering is planned [m]");
    v("heading_weight_m", heading_weight_m, config::Range{0.0, 5.0},
      "Weight of the heading error against the lateral error [m]");
  }
};

/// What the plan wants at a place of the path.
struct PlannedSteering {
  double curvature = 0.0;  ///< of the vehicle [1/m, positive left, in both gears]
  double lateral = 0.0;    ///< of the vehicle off the path [m, positive left of the heading]
  double heading = 0.0;    ///< of the vehicle against the path [rad]
};

/// The steering along a reference whose curvature steps, as a vehicle with a limited steering rate
/// can follow it best: it turns the wheels before the step and after it so that the error is split,
/// and knows what error remains. Away from steps it is the path's own curvature, along clothoids
/// too.
class SteeringPlan {
 public:
  /// O(pieces + planned length / step). `speeds` belongs to the reference.
  void build(const Reference& reference, const SpeedProfile& speeds, const Vehicle& vehicle,
             const SteeringPlanConfig& config);
  /// At driven distance `s` [m] of segment number `segment`. Does not allocate.
  PlannedSteering at(const Path& path, double s, int segment) const;

 private:
  struct Node {
    double s = 0.0;
    PlannedSteering wanted;
  };
  // A planned stretch of one segment: nodes [first, last].
  struct Window {
    double begin_s = 0.0;
    double end_s = 0.0;
    int segment = 0;
    std::size_t first = 0;
    std::size_t last = 0;
  };
  struct Builder;

  std::vector<Node> nodes_;
  std::vector<Window> windows_;
};

}  // namespace headland
