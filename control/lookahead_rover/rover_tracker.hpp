// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/position_filter.hpp"
#include "control/speed_limits.hpp"
#include "control/speed_profile.hpp"
#include "control/speed_ramp.hpp"
#include "control/tracker.hpp"
#include "core/config/visit.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

struct RoverTrackerConfig {
  /// Natural frequency of the lateral error per metre driven [1/m]; 1/k is the distance over which
  /// an error fades.
  double stiffness_1pm = 0.8;
  double damping_ratio = 1.0;
  /// Steepest approach to the path, however far off it the vehicle is [deg].
  double max_approach_deg = 40.0;
  double max_yaw_rate_radps = 2.0;
  /// A heading error beyond the first stops the vehicle, which then turns on the spot until the
  /// error is below the second [deg].
  double pivot_from_deg = 60.0;
  double pivot_until_deg = 2.0;
  /// A cusp or the end is reached when this near it along the path, or past it [m].
  double stop_tolerance_m = 0.002;
  /// Farther from the path than this, the vehicle stops [m].
  double lost_beyond_m = 2.0;
  /// How far from the last progress the nearest point of the path is sought, both ways [m].
  double search_m = 2.0;
  /// Age of the measured speed and heading [s]. Zero for values of now; half a cycle where they are
  /// those of the whole last cycle, as for a rover that turns first and then moves (seed 004).
  double motion_age_s = 0.0;
  PositionFilterConfig filter;

  template <class V>
  void visit(V& v) {
    v("stiffness_1pm", stiffness_1pm, config::Range{0.01, 10.0},
      "Natural frequency of the lateral error per metre driven [1/m]");
    v("damping_ratio", damping_ratio, config::Range{0.1, 5.0}, "Of the lateral error");
    v("max_approach_deg", max_approach_deg, config::Range{1.0, 80.0},
      "Steepest approach to the path [deg]");
    v("max_yaw_rate_radps", max_yaw_rate_radps, config::kPositive, "Fastest turn [rad/s]");
    v("pivot_from_deg", pivot_from_deg, config::Range{5.0, 180.0},
      "Heading error from which the vehicle turns on the spot [deg]");
    v("pivot_until_deg", pivot_until_deg, config::Range{0.1, 60.0},
      "Heading error that ends turning on the spot [deg]");
    v("stop_tolerance_m", stop_tolerance_m, config::kPositive,
      "Nearer to a cusp or the end than this counts as there [m]");
    v("lost_beyond_m", lost_beyond_m, config::kPositive,
      "Farther from the path than this the vehicle stops [m]");
    v("search_m", search_m, config::kPositive,
      "How far around the last progress the nearest point is sought [m]");
    v("motion_age_s", motion_age_s, config::kNonNegative,
      "Age of the measured speed and heading [s]");
    v("filter", filter, "Position from noisy fixes and odometry");
  }
};

/// Our follower for differential vehicles, against the exact path instead of its waypoints: the
/// path's own turn fed forward, feedback on lateral and heading error (after Samson's path-frame
/// kinematics), speed with acceleration, standstill and gear change at cusps, turning on the spot
/// where the heading is far off. Deterministic; step() does not allocate.
class RoverTracker : public Tracker {
 public:
  RoverTracker(const Vehicle& vehicle, const RoverTrackerConfig& config,
               const SpeedLimitConfig& limits = {});

  /// Where the vehicle believes to be [m, map].
  Point2 position_estimate() const { return filter_.position(); }

 private:
  enum class Mode { kDriving, kPivoting, kChangingGear, kDone };
  // The state relative to the path, for one tick.
  struct Errors {
    Projection nearest;
    double heading = 0.0;    // of the direction of travel against the path's [rad], positive left
    double path_turn = 0.0;  // of the path over the coming cycle, per metre driven [rad/m]
    double remaining = 0.0;  // to the end of the segment [m]
  };

  Result<void> do_start() override;
  TrackOutput do_step(const VehicleEstimate& estimate, double dt) override;

  Point2 odometry(const VehicleState& measured, double dt) const;
  Errors errors(const VehicleState& measured, const Point2& position, double dt) const;
  Command drive(const VehicleState& measured, const Errors& errors, double dt);
  Command pivot(const VehicleState& measured, const Errors& errors, double dt);
  TrackOutput stand(TrackStatus status) const { return {{}, status, s_}; }

  Vehicle vehicle_;
  RoverTrackerConfig config_;
  SpeedLimitConfig limits_;
  PositionFilter filter_;
  SpeedRamp ramp_;
  SpeedProfile profile_;
  Mode mode_ = Mode::kDone;
  int segment_ = 0;
  double s_ = 0.0;              // progress [m]
  double standing_left_ = 0.0;  // of a gear change [s]
  VehicleState last_;           // measured one tick ago
  bool has_last_ = false;
};

}  // namespace headland
