// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"

namespace headland {

/// Seed 004's follower, as published: the baseline that RoverTracker is measured against.
struct SeedLookaheadConfig {
  /// LD: radius of the circle that finds the local goal point [m]; (004) Sec. 3, best value.
  double lookahead_m = 0.75;
  /// D_th: a waypoint nearer than this counts as crossed [m]. (004) gives no value. Below the
  /// lookahead the published rule picks a goal behind the rover as soon as the waypoints stand
  /// farther apart than the lookahead, so it equals the lookahead here.
  double crossed_within_m = 0.75;
  double speed_mps = 7.0 / 3.6;  ///< v_t [m/s]; 7 km/h, (004) Table 1
  /// Smaller steering angles are not corrected [deg]; 2.5 in (004) Table 3, 0 elsewhere.
  double steering_threshold_deg = 0.0;

  template <class V>
  void visit(V& v) {
    v("lookahead_m", lookahead_m, config::kPositive, "LD: radius that finds the goal point [m]");
    v("crossed_within_m", crossed_within_m, config::kPositive,
      "D_th: a waypoint nearer than this counts as crossed [m]");
    v("speed_mps", speed_mps, config::kPositive, "v_t: speed without steering [m/s]");
    v("steering_threshold_deg", steering_threshold_deg, config::Range{0.0, 90.0},
      "Smaller steering angles are not corrected [deg]");
  }
};

/// What the follower decided in one cycle.
struct SeedLookaheadStep {
  double speed = 0.0;     ///< v [m/s]; (004) Eq. 7
  double yaw_rate = 0.0;  ///< [rad/s]; (004) Eq. 6
  double steering = 0.0;  ///< theta [rad]; (004) Eq. 5
  Point2 goal{0.0, 0.0};  ///< the local goal point, or the waypoint fallen back to
  bool goal_found = false;
  bool done = false;  ///< the last waypoint is crossed; speed and yaw_rate are zero
};

/// Where on the segment p1-p2 a circle crosses it: the fraction in [0, 1] of the crossing nearest
/// to p2, or nothing when it crosses outside the segment or not at all ((004) Fig. 10 a-d).
std::optional<double> last_circle_crossing(const Point2& center, double radius, const Point2& p1,
                                           const Point2& p2);

/// Path following of seed 004, Sec. 2.4: aims at a goal point on the circle around the rover, on
/// the first segment from the current index on that the circle crosses, and falls back to the last
/// waypoint crossed. Deterministic; step() does not allocate.
class SeedLookaheadRover {
 public:
  /// Requires at least two waypoints.
  SeedLookaheadRover(const SeedLookaheadConfig& config, std::vector<Point2> waypoints);

  /// One cycle of `cycle` [s] from the measured pose (its position may be noisy).
  SeedLookaheadStep step(const Pose2& measured, double cycle);

  /// The last waypoint crossed, 0-based.
  int current_index() const { return current_; }
  const std::vector<Point2>& waypoints() const { return waypoints_; }

 private:
  void advance_index(const Point2& p);
  std::optional<Point2> local_goal(const Point2& p) const;

  SeedLookaheadConfig config_;
  std::vector<Point2> waypoints_;
  int current_ = 0;
};

/// The rover of the seed's simulation, read so that its published figures come out: it takes the
/// whole yaw of the cycle first, then drives straight. `cycle` [s].
Pose2 turn_then_move(const Pose2& pose, double speed, double yaw_rate, double cycle);

}  // namespace headland
