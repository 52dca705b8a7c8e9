// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/clock.hpp"
#include "core/config/visit.hpp"
#include "core/model/vehicle.hpp"
#include "local_planner/local_planner.hpp"
#include "sim/crowd/crowd.hpp"
#include "sim/lab/acfr/site.hpp"

namespace headland {

/// The world of seed 003's study beside its terrain: agents, sensors, clocks (IV-A, IV-B).
struct AcfrWorldConfig {
  double agent_radius_m = 0.5;
  double agent_speed_min_mps = 0.1;
  double agent_speed_max_mps = 1.5;
  double robot_radius_m = 1.5;
  double slack_m = 0.01;
  double robot_share_ratio = 0.5;
  double margin_m = 8.0;
  double step_s = 0.1;
  double plan_period_s = 0.4;
  double view_m = 20.0;
  double agent_noise_ratio = 0.0125;
  double position_noise_m = 0.03;
  double heading_noise_deg = 0.5;
  double speed_mps = 1.5;
  double timeout_s = 300.0;
  double interaction_m = 6.0;
  double near_m = 2.0;
  CrowdConfig crowd;

  template <class V>
  void visit(V& v) {
    v("agent_radius_m", agent_radius_m, config::kPositive, "Of agents among themselves [m]");
    v("agent_speed_min_mps", agent_speed_min_mps, config::Range{0.0, 10.0},
      "Agents prefer speeds from this ... [m/s]");
    v("agent_speed_max_mps", agent_speed_max_mps, config::Range{0.01, 10.0},
      "... to this, which is also the most they do to give way [m/s]");
    v("robot_radius_m", robot_radius_m, config::kNonNegative,
      "That agents assume of the robot [m]");
    v("slack_m", slack_m, config::Range{0.0, 1.0},
      "By which agents widen both radii, so that they do not graze (CrowdNav's ORCA: 0.01) [m]");
    v("robot_share_ratio", robot_share_ratio, config::kFraction,
      "Of the avoidance that agents take on towards the robot; 0: it is invisible to them");
    v("margin_m", margin_m, config::kNonNegative,
      "Agents live in the rectangle around all waypoints, this much larger on all sides [m]");
    v("step_s", step_s, config::Range{0.02, 0.2}, "Of agents and robot [s]");
    v("plan_period_s", plan_period_s, config::Range{0.02, 2.0}, "Between decisions [s]");
    v("view_m", view_m, config::kPositive, "The robot sees agents up to here [m]");
    v("agent_noise_ratio", agent_noise_ratio, config::Range{0.0, 0.2},
      "Standard deviation of a seen position over its distance");
    v("position_noise_m", position_noise_m, config::Range{0.0, 1.0},
      "Of the robot's own position, per axis [m]");
    v("heading_noise_deg", heading_noise_deg, config::Range{0.0, 10.0}, "Of its heading [deg]");
    v("speed_mps", speed_mps, config::Range{0.1, 10.0}, "That the robot wants [m/s]");
    v("timeout_s", timeout_s, config::Range{1.0, 3600.0},
      "After so long a waypoint is given up [s]");
    v("interaction_m", interaction_m, config::kPositive,
      "An interaction lasts while an agent's centre is this near to the robot's [m]");
    v("near_m", near_m, config::kPositive, "It is a near-collision if they come this near [m]");
    v("crowd", crowd, "How agents avoid each other");
  }
};

/// A waypoint of an episode.
struct AcfrVisit {
  double distance_m = 0.0;  ///< straight, when it became the next
  double time_s = 0.0;      ///< until it was reached, or given up
  bool reached = false;
};

/// An agent that came near.
struct AcfrInteraction {
  double least_m = 0.0;        ///< between the centres
  bool near = false;           ///< nearer than near_m, ...
  bool robot_fault = false;    ///< ... and when it came so near, the robot closed in the faster
  bool contact = false;        ///< outline and disc overlapped, ...
  bool robot_contact = false;  ///< ... and the robot moved towards the agent by more than 0.05 m/s
};

/// What was where at a moment, for pictures.
struct AcfrFrame {
  double time_s = 0.0;
  VehicleState robot;
  int place = 0;
  LocalStatus status = LocalStatus::kPlanned;
  std::vector<Point2> agents;
};

/// An iteration of the study, driven.
struct AcfrOutcome {
  std::vector<AcfrVisit> visits;
  std::vector<AcfrInteraction> interactions;
  /// Every 5 s: time [s] and distance from the global path [m].
  std::vector<std::pair<double, double>> displacements;
  std::vector<double> plan_ms;  ///< of each decision, if there is a clock
  double duration_s = 0.0;
  double length_m = 0.0;
  double standing_s = 0.0;  ///< slower than 0.01 m/s
  double longest_stand_s = 0.0;
  std::vector<AcfrFrame> frames;  ///< if asked for
};

struct AcfrDrive {
  const AcfrTour* tour = nullptr;
  const AcfrWorldConfig* world = nullptr;
  Vehicle vehicle;
  double density_m2 = 10.0;  ///< area per agent
  double accuracy_m = 1.0;
  PlanBudget budget;
  std::uint64_t seed = 1;
  const Clock* clock = nullptr;  ///< for plan_ms only
  bool keep_frames = false;
};

/// Drives one iteration among agents. The same seed and tour give the same agents, whoever plans.
AcfrOutcome drive_acfr(const AcfrDrive& drive, LocalPlanner& planner);

}  // namespace headland
