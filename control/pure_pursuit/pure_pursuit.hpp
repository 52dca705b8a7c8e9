// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/path_progress.hpp"
#include "control/position_filter.hpp"
#include "control/pure_pursuit/steering_plan.hpp"
#include "control/speed_limits.hpp"
#include "control/speed_profile.hpp"
#include "control/speed_ramp.hpp"
#include "control/tracker.hpp"
#include "core/config/visit.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

struct PurePursuitConfig {
  /// Lookahead along the path: this much [m] plus this time's travel [s] plus the travel while the
  /// wheels turn by this angle [deg]: slow steering must look farther to be stable.
  double lookahead_m = 0.5;
  double lookahead_time_s = 0.25;
  double lookahead_turn_deg = 30.0;
  /// Dead time between a command and the actuators [s], beside their rate and lag.
  double dead_time_s = 0.0;
  /// At a standstill the wheels are ready within this of the wanted angle [deg].
  double steering_tolerance_deg = 0.5;
  /// A cusp or the end is reached when this near it along the path, or past it [m].
  double stop_tolerance_m = 0.002;
  /// Farther from the path than this, the vehicle stops [m].
  double lost_beyond_m = 2.0;
  /// How far from the last progress the nearest point of the path is sought, both ways [m].
  double search_m = 1.0;
  SteeringPlanConfig plan;
  PositionFilterConfig filter;

  template <class V>
  void visit(V& v) {
    v("lookahead_m", lookahead_m, config::Range{0.05, 20.0},
      "Lookahead along the path at a standstill [m]");
    v("lookahead_time_s", lookahead_time_s, config::Range{0.0, 10.0},
      "Lookahead added per speed [s]");
    v("lookahead_turn_deg", lookahead_turn_deg, config::Range{0.0, 180.0},
      "Lookahead added for the time in which the wheels turn by this [deg]");
    v("dead_time_s", dead_time_s, config::Range{0.0, 2.0},
      "From a command to the actuators' answer, beside rate and lag [s]");
    v("steering_tolerance_deg", steering_tolerance_deg, config::Range{0.01, 10.0},
      "Standing, the wheels are ready within this of the wanted angle [deg]");
    v("stop_tolerance_m", stop_tolerance_m, config::kPositive,
      "Nearer to a cusp or the end than this counts as there [m]");
    v("lost_beyond_m", lost_beyond_m, config::kPositive,
      "Farther from the path than this the vehicle stops [m]");
    v("search_m", search_m, config::kPositive,
      "How far around the last progress the nearest point is sought [m]");
    v("plan", plan, "Steering planned ahead along the path");
    v("filter", filter, "Position from noisy fixes and odometry");
  }
};

/// Our follower for Ackermann vehicles: the steering planned ahead for the actuator's rate fed
/// forward, and pure pursuit (Coulter 1992) on the deviation from that plan: the curvature towards
/// the lookahead point less what it would be with the vehicle where the plan has it, so that the
/// lookahead does not cut corners. Rear axle, both gears; never looks past a cusp. Deterministic;
/// step() does not allocate.
class PurePursuit : public Tracker {
 public:
  PurePursuit(const Vehicle& vehicle, const PurePursuitConfig& config,
              const SpeedLimitConfig& limits = {});

  /// Where the vehicle believes to be [m, map].
  Point2 position_estimate() const { return filter_.position(); }

 private:
  // Standing: the wheels turn to the angle of the start or behind the cusp, the gear changes.
  // Stopping: past the end, not yet still.
  enum class Mode { kStanding, kDriving, kStopping, kDone };

  Result<void> do_start() override;
  TrackOutput do_step(const VehicleEstimate& estimate, double dt) override;

  Point2 odometry(const VehicleState& measured, double dt) const;
  Pose2 planned_pose(double s) const;
  double pursuit(const Pose2& pose, const Point2& target) const;
  double command_angle(double wanted, double actual, double dt) const;
  double planned_angle() const;
  TrackOutput arrive(const VehicleState& measured);
  TrackOutput stand(const VehicleState& measured, double dt);
  TrackOutput drive(const VehicleState& measured, const Pose2& pose, double dt);
  TrackOutput stop(const VehicleState& measured, TrackStatus status) const;

  Vehicle vehicle_;
  PurePursuitConfig config_;
  SpeedLimitConfig limits_;
  PositionFilter filter_;
  SpeedRamp ramp_;
  SpeedProfile profile_;
  SteeringPlan plan_;
  Mode mode_ = Mode::kDone;
  PathProgress progress_;
  double gear_left_ = 0.0;      // standing time of the gear change under way [s]
  double steering_left_ = 0.0;  // longest time to wait for the wheels [s]
  bool changing_gear_ = false;
  VehicleState last_;  // measured one tick ago
  bool has_last_ = false;
};

}  // namespace headland
