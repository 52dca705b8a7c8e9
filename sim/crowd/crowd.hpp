// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "core/config/visit.hpp"
#include "core/geometry/region.hpp"
#include "core/model/orca.hpp"
#include "core/world/agent.hpp"
#include "sim/crowd/nearest.hpp"

namespace headland {

/// How an agent of a crowd moves.
enum class Behaviour : std::int8_t {
  kOrca,       ///< to its goal, giving way to other agents and to robots (ORCA)
  kOrcaBlind,  ///< likewise, but it does not see robots
  kIgnore      ///< straight to its goal; sees nobody and nothing
};

/// Someone in a crowd.
struct CrowdAgent {
  AgentKind kind = AgentKind::kPerson;
  Behaviour behaviour = Behaviour::kOrca;
  Point2 position{0.0, 0.0};   ///< [m, map]
  Point2 velocity{0.0, 0.0};   ///< [m/s]
  Point2 goal{0.0, 0.0};       ///< [m, map]
  double radius_m = 0.5;       ///< seed 003
  double speed_mps = 1.0;      ///< that it prefers, >= 0
  double max_speed_mps = 1.5;  ///< >= 0; seed 003: 0.1 to 1.5 m/s
};

/// A robot, as a crowd sees it.
struct CrowdRobot {
  Point2 position{0.0, 0.0};  ///< [m, map]
  Point2 velocity{0.0, 0.0};  ///< [m/s]
  double radius_m = 1.5;      ///< that agents assume (seed 003: among themselves 0.5 m)
  double share = 0.5;         ///< of the avoidance that agents take on; 1: all; 0: they ignore it
};

/// A new goal for an agent that has reached its own; none: it stays there.
using GoalRule = std::function<std::optional<Point2>(const CrowdAgent&, RandomStream&)>;
/// Goals uniform in an area.
GoalRule goals_within(const Region& area);

struct CrowdConfig {
  double horizon_s = 3.0;
  double obstacle_horizon_s = 3.0;
  double neighbor_distance_m = 10.0;
  int max_neighbor_count = 10;
  double arrival_m = 1.0;
  double nudge_mps = 1e-4;

  template <class V>
  void visit(V& v) {
    v("horizon_s", horizon_s, config::kPositive,
      "Agents keep away from others for this long, if all go on as they do [s]");
    v("obstacle_horizon_s", obstacle_horizon_s, config::kPositive, "... and from obstacles [s]");
    v("neighbor_distance_m", neighbor_distance_m, config::kNonNegative,
      "Agents see others, by their centres, up to here [m]");
    v("max_neighbor_count", max_neighbor_count, config::Range{0, 1000},
      "... and of these the nearest, beside all robots");
    v("arrival_m", arrival_m, config::kNonNegative,
      "Agents this near to their goal get a new one [m]");
    v("nudge_mps", nudge_mps, config::kNonNegative,
      "Random part of what agents prefer, so that none stand face to face for ever [m/s]");
  }
};

/// The people and animals of a simulated farm, in lock-step. All agents choose their velocities by
/// the same moment, then all move. Deterministic for a seed. No agent's state is ever anything but
/// a number, whatever the input: agents that hold anything else are left out, robots not seen.
class Crowd {
 public:
  /// The agents' ids are their places in the list. Speeds and radii below 0 count as 0.
  Crowd(const CrowdConfig& config, std::vector<CrowdAgent> agents, OrcaObstacles obstacles = {},
        std::uint64_t seed = 0, GoalRule goals = {});

  /// `dt` [s] on; not finite or not > 0: nothing happens. Does not allocate (but for the rule of
  /// goals). O(n log n); about 1 us per agent.
  void step(double dt, std::span<const CrowdRobot> robots = {});
  double time_s() const { return time_s_; }
  /// All agents, as a perfect sensor sees them.
  std::span<const Agent> agents() const { return seen_; }
  /// The same, with what only they know.
  std::span<const CrowdAgent> members() const { return members_; }

 private:
  Point2 preferred_velocity(const CrowdAgent& agent);
  Point2 avoiding_velocity(std::size_t self, const Point2& preferred, double dt,
                           std::span<const CrowdRobot> robots);
  void append_neighbor_lines(std::size_t self, double dt);
  void append_robot_lines(const CrowdAgent& agent, double dt, std::span<const CrowdRobot> robots);

  CrowdConfig config_;
  std::vector<CrowdAgent> members_;
  std::vector<Agent> seen_;
  OrcaObstacles obstacles_;
  GoalRule goals_;
  RandomStream goal_stream_;
  RandomStream nudge_stream_;
  double time_s_ = 0.0;

  Nearest nearest_;
  std::vector<Point2> positions_;
  std::vector<Point2> velocities_;  // the next ones
  std::vector<Near> near_;
  std::vector<VelocityLine> lines_;
  std::vector<VelocityLine> scratch_;
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::Behaviour> {
  static constexpr std::pair<headland::Behaviour, std::string_view> values[] = {
      {headland::Behaviour::kOrca, "orca"},
      {headland::Behaviour::kOrcaBlind, "orca_blind"},
      {headland::Behaviour::kIgnore, "ignore"}};
};
