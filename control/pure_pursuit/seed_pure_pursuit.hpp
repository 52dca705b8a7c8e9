// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "core/config/visit.hpp"
#include "core/geometry/pose2.hpp"

namespace headland {

/// What seed 002's controller follows: waypoints cut into links (a row, a headland turn, the way
/// from or to the depot), and one guided point a link.
struct SeedRoute {
  std::vector<Point2> points;  ///< [m]
  std::vector<int> link;       ///< of each point; never decreases, starts at 0
  std::vector<bool> is_turn;   ///< of each link
  std::vector<Point2> guided;  ///< of each link [m]

  int links() const { return static_cast<int>(is_turn.size()); }
  /// Index of the last point of a link.
  int last_point(int of_link) const;
  /// The point of the same link that lies at least `lookahead` [m] of driven distance after point
  /// `index`; the link's last one where it ends before. (002) Alg. 3, lines 17-21
  const Point2& goal(int index, double lookahead) const;
};

/// (002) Alg. 3, line 23: kappa = 2 y / Ld^2 with the nominal Ld, delta = atan(L kappa) [rad].
double seed_steering(const Point2& goal, const Pose2& T_map_base, double lookahead,
                     double wheelbase);

/// Parameters of seed 002's controller; the defaults are those of its part D.
struct SeedPurePursuitConfig {
  double wheelbase_m = 2.5;  ///< (002) part D; the text of Sec. 2.1 says 3
  double max_steering_deg = 60.0;
  double lookahead_line_m = 1.0;
  double lookahead_turn_m = 0.8;
  double override_beyond_m = 10.0;
  int links_ahead = 3;
  bool segment_bounded = true;

  template <class V>
  void visit(V& v) {
    v("wheelbase_m", wheelbase_m, config::kPositive, "Of the controller's model [m]");
    v("max_steering_deg", max_steering_deg, config::Range{1.0, 80.0}, "Saturation [deg]");
    v("lookahead_line_m", lookahead_line_m, config::kPositive,
      "In rows, and on the first and last link [m]");
    v("lookahead_turn_m", lookahead_turn_m, config::kPositive, "In headland turns [m]");
    v("override_beyond_m", override_beyond_m, config::kPositive,
      "The guided point takes over only farther away than this [m]");
    v("links_ahead", links_ahead, config::kNonNegative,
      "Links after the present one that the search for the nearest waypoint may reach");
    v("segment_bounded", segment_bounded,
      "false: the plain controller of the course's second assignment, one global polyline");
  }
};

/// Seed 002's segment-bounded pure pursuit (Algorithm 3) as its authors ran it, kept as a
/// yardstick: forward only, curvature from the nominal lookahead distance rather than from the true
/// one.
class SeedPurePursuit {
 public:
  struct Output {
    double steering = 0.0;  ///< [rad], saturated
    int link = 0;
    bool guided = false;  ///< the guided point has taken over
  };

  /// `route` must outlive the controller.
  SeedPurePursuit(const SeedPurePursuitConfig& config, const SeedRoute& route);

  /// One control period. Does not allocate.
  Output step(const Pose2& T_map_base);

 private:
  Output step_bounded(const Pose2& T_map_base);
  Output step_plain(const Pose2& T_map_base) const;
  double saturate(double steering) const;

  SeedPurePursuitConfig config_;
  const SeedRoute& route_;
  double limit_ = 0.0;  // [rad]
  int index_ = 0;       // nearest waypoint; never decreases
  int link_ = 0;
  double guided_before_ = std::numeric_limits<double>::infinity();  // [m]
  double next_before_ = std::numeric_limits<double>::infinity();    // [m]
};

}  // namespace headland
