// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "core/config/visit.hpp"
#include "local_planner/fail_safe/sweep.hpp"
#include "local_planner/local_planner.hpp"
#include "local_planner/outline.hpp"

namespace headland {

/// How agents are expected to go on.
enum class AgentMotion {
  kWorstCase,  ///< in any direction, at `agent_speed_mps` or as fast as seen
  kObserved    ///< as seen, with a change of velocity of at most `agent_acceleration_mps2`
};

/// Settings of the fail-safe layer. Symbols: ISO/TS 15066:2016, 5.5.4.2.
struct FailSafeConfig {
  AgentMotion agents = AgentMotion::kWorstCase;
  /// Tr: from the sight of someone to the brakes, beside the drive's dead time and the scene's
  /// known age; at least one cycle of control.
  double reaction_time_s = 0.3;
  double agent_speed_mps = 1.6;  ///< vh: the standard's for people who are not tracked
  double agent_acceleration_mps2 = 2.0;
  double intrusion_m = 0.3;     ///< C: what of a person reaches beyond its disc
  double agent_error_m = 0.15;  ///< Zd: of the agents' positions, beside `noise_ratio`
  double robot_error_m = 0.1;   ///< Zr: of the robot's own
  double noise_ratio = 2.0;     ///< standard deviations of an agent's position added to Zd
  double near_m = 0.3;          ///< the zone all round
  double near_speed_mps = 0.3;  ///< ISO 3691-4:2020: with personnel detection muted
  double max_age_s = 0.5;
  double cycle_s = 0.05;

  double allowances() const { return intrusion_m + agent_error_m + robot_error_m; }

  template <class V>
  void visit(V& v) {
    v("agents", agents, "worst_case or observed: how agents are expected to go on");
    v("reaction_time_s", reaction_time_s, config::Range{0.0, 5.0},
      "From the sight of someone to the brakes [s]");
    v("agent_speed_mps", agent_speed_mps, config::Range{0.0, 20.0},
      "Speed that an agent may come at in the worst case [m/s]");
    v("agent_acceleration_mps2", agent_acceleration_mps2, config::Range{0.0, 20.0},
      "Fastest change of an agent's velocity where it is observed [m/s2]");
    v("intrusion_m", intrusion_m, config::Range{0.0, 5.0},
      "What of an agent reaches beyond its disc [m]");
    v("agent_error_m", agent_error_m, config::Range{0.0, 5.0}, "Error of agents' positions [m]");
    v("robot_error_m", robot_error_m, config::Range{0.0, 5.0}, "Error of the robot's position [m]");
    v("noise_ratio", noise_ratio, config::Range{0.0, 10.0},
      "Standard deviations of an agent's position that count as error");
    v("near_m", near_m, config::Range{0.0, 5.0}, "Nearer than this all round the robot creeps [m]");
    v("near_speed_mps", near_speed_mps, config::Range{0.0, 2.0}, "Speed of creeping [m/s]");
    v("max_age_s", max_age_s, config::Range{0.0, 10.0}, "Older scenes stop the robot [s]");
    v("cycle_s", cycle_s, config::kPositive, "Between two commands [s]");
  }
};

/// Why a command was limited.
enum class SafetyReason {
  kNone,      ///< it was not
  kAgent,     ///< someone may come into the swept way before the robot stands
  kNear,      ///< someone is within the zone all round
  kObstacle,  ///< a static obstacle within the stopping distance
  kStale,     ///< the scene is too old
  kBadInput   ///< a number is none
};

/// What the fail-safe makes of a command.
struct SafeCommand {
  Command command;
  double allowed_speed = 0.0;  ///< in the gear under way [m/s, >= 0]; on the spot [rad/s]. At most
                               ///< the faster of what is wanted and what is driven
  SafetyReason reason = SafetyReason::kNone;
  int nearest = -1;  ///< index of the agent that limits, or else of the nearest; -1: nobody
  double gap = 1e3;  ///< outline to the nearest agent's disc [m]
};

/// Beneath whichever planner drives: lets a command through only as fast as the robot can stop
/// before anyone who is in its way, or may get there, is touched; and before static obstacles.
///
/// Speed and separation as in ISO/TS 15066 (Sp = vh (Tr + Ts) + vr Tr + Ss + C + Zd + Zr <= d), in
/// time and in the plane: for a speed the whole stop is swept (reaction, braking, lag; the steering
/// on its way to what is commanded), and no agent may be able to get to an edge of the outline that
/// moves outwards before the robot stands. Straight ahead this is the standard's formula; whoever
/// is behind or beside a robot that leaves him does not count. A turn that is only safe more slowly
/// waits, the last safe steering held, until the robot is that slow; so that one certified stop
/// follows from the other. What it cannot know: agents that nobody sees, and slip.
///
/// Never speeds up; stops for what is no number and for old scenes. Both gears; a change of gear or
/// of turning on the spot begins from a stand. One object per robot, called each cycle.
/// Deterministic; about 70 us with 50 agents near. Does not allocate once it has seen as many.
class FailSafe {
 public:
  FailSafe(const Vehicle& vehicle, const FailSafeConfig& config = {});

  SafeCommand limit(const LocalScene& scene, const Command& wanted);

 private:
  struct Verdict {
    bool safe = true;
    SafetyReason reason = SafetyReason::kNone;
    int agent = -1;
  };
  struct Allowed {
    double speed = 0.0;
    Verdict why;
  };

  bool stops_first(const Command& wanted, double direction) const;
  Turn turn_of(const Command& wanted, const VehicleState& state) const;
  Turn held_turn(const LocalScene& scene) const;
  void find_near(const LocalScene& scene, double cap, bool on_the_spot, SafeCommand& out);
  Stopping stop_of(bool on_the_spot, double speed) const;
  double fastest(const Agent& agent) const;
  double touch_radius(const Agent& agent) const;
  bool may_touch(const Sweep& sweep, const Agent& agent, double age) const;
  Verdict check(const LocalScene& scene, const Turn& turn, double direction, double speed);
  Allowed allowed(const LocalScene& scene, const Turn& turn, double direction, double cap);
  bool leaves(const LocalScene& scene, const Turn& turn, double direction, int agent) const;
  Command command(const VehicleState& state, const Turn& turn, double direction,
                  double speed) const;
  SafeCommand stop(const VehicleState& state, SafetyReason reason) const;

  Vehicle vehicle_;
  FailSafeConfig config_;
  OutlineDiscs discs_;
  OutlineDisc disc_;
  double reaction_;        // with the drive's dead time [s]
  Turn held_;              // of the last certified command
  double held_at_ = -1e9;  // [s]
  std::vector<int> near_;  // agents that may matter, the last one in the way first
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::AgentMotion> {
  static constexpr std::pair<headland::AgentMotion, std::string_view> values[] = {
      {headland::AgentMotion::kWorstCase, "worst_case"},
      {headland::AgentMotion::kObserved, "observed"}};
};
template <>
struct headland::config::EnumNames<headland::SafetyReason> {
  static constexpr std::pair<headland::SafetyReason, std::string_view> values[] = {
      {headland::SafetyReason::kNone, "none"},   {headland::SafetyReason::kAgent, "agent"},
      {headland::SafetyReason::kNear, "near"},   {headland::SafetyReason::kObstacle, "obstacle"},
      {headland::SafetyReason::kStale, "stale"}, {headland::SafetyReason::kBadInput, "bad_input"}};
};
