// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "core/config/visit.hpp"
#include "core/geometry/region.hpp"
#include "core/model/herd.hpp"
#include "core/model/orca.hpp"
#include "core/world/agent.hpp"
#include "sim/crowd/neighbors.hpp"
#include "sim/crowd/tracks.hpp"

namespace headland {

/// How an agent of a crowd moves.
enum class Behaviour : std::int8_t {
  kOrca,       ///< to its goal, giving way to other agents and to robots (ORCA)
  kOrcaBlind,  ///< likewise, but it does not see robots
  kIgnore,     ///< straight to its goal; sees nobody and nothing
  kHerd,       ///< as an animal of a herd; cattle as CrowdConfig::cattle, all others as sheep
  kReplay      ///< as recorded (Crowd::replay)
};

/// Someone in a crowd.
struct CrowdAgent {
  AgentKind kind = AgentKind::kPerson;
  Behaviour behaviour = Behaviour::kOrca;
  Point2 position{0.0, 0.0};   ///< [m, map]
  Point2 velocity{0.0, 0.0};   ///< [m/s]
  Point2 goal{0.0, 0.0};       ///< [m, map]; not of a herd
  double radius_m = 0.5;       ///< seed 003
  double speed_mps = 1.0;      ///< that it prefers, >= 0; a herd's are its model's
  double max_speed_mps = 1.5;  ///< >= 0; seed 003: 0.1 to 1.5 m/s; a herd's are its model's
  double flight_m = -1.0;      ///< in a herd: flees from whom is nearer; < 0: its model's
};

/// A robot, as a crowd sees it.
struct CrowdRobot {
  Point2 position{0.0, 0.0};  ///< [m, map]
  Point2 velocity{0.0, 0.0};  ///< [m/s]
  double radius_m = 1.5;      ///< that agents assume (seed 003: among themselves 0.5 m)
  double share = 0.5;         ///< of the avoidance that agents take on; 1: all; 0: nobody sees it
};

/// A new goal for an agent that has reached its own; none: it stays there.
using GoalRule = std::function<std::optional<Point2>(const CrowdAgent&, RandomStream&)>;
/// Goals uniform in an area.
GoalRule goals_within(const Region& area);

struct CrowdConfig {
  double horizon_s = 3.0;
  double obstacle_horizon_s = 3.0;
  double contact_horizon_s = 0.5;
  double neighbor_distance_m = 10.0;
  int max_neighbor_count = 10;
  double arrival_m = 1.0;
  double nudge_mps = 1e-4;
  HerdModel sheep;
  HerdModel cattle = cattle_herd();

  template <class V>
  void visit(V& v) {
    v("horizon_s", horizon_s, config::kPositive,
      "Agents keep away from others for this long, if all go on as they do [s]");
    v("obstacle_horizon_s", obstacle_horizon_s, config::kPositive, "... and from obstacles [s]");
    v("contact_horizon_s", contact_horizon_s, config::kPositive,
      "... and animals of a herd from bodies, as they only avoid to bump into them [s]");
    v("neighbor_distance_m", neighbor_distance_m, config::kNonNegative,
      "Agents see others, by their centres, up to here [m]");
    v("max_neighbor_count", max_neighbor_count, config::Range{0, 1000},
      "... and of these the nearest, beside all robots");
    v("arrival_m", arrival_m, config::kNonNegative,
      "Agents this near to their goal get a new one [m]");
    v("nudge_mps", nudge_mps, config::kNonNegative,
      "Random part of what agents prefer, so that none stand face to face for ever [m/s]");
    v("sheep", sheep, "Herds of sheep");
    v("cattle", cattle, "Herds of cattle");
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
  /// Adds those of a recording, each while it lasts; it begins at `begin_s` of the crowd's time,
  /// and lies on the farm at `T_map_tracks`. Their ids follow on all others. Before the first step.
  void replay(const TrackSet& tracks, const Pose2& T_map_tracks = {}, double begin_s = 0.0);

  /// `dt` [s] on; not finite or not > 0: nothing happens. Does not allocate after the first step,
  /// but for more than 16 robots, more recorded agents than so far, and in the rule of goals. O(n
  /// log n); about 0.5 us an agent.
  void step(double dt, std::span<const CrowdRobot> robots = {});
  double time_s() const { return time_s_; }
  /// All who are there, as a perfect sensor sees them.
  std::span<const Agent> agents() const { return seen_; }

 private:
  struct Member {
    CrowdAgent agent;
    int id = 0;
    bool here = true;
    Point2 next{0.0, 0.0};         // velocity
    Point2 noise{1.0, 0.0};        // of an animal
    std::optional<Track> track{};  // of one that is replayed
  };
  void look(std::span<const CrowdRobot> robots);
  Point2 next_velocity(std::size_t place, double dt, std::span<const CrowdRobot> robots);
  Point2 goal_velocity(const CrowdAgent& agent);
  Point2 animal_velocity(std::size_t place, double dt);
  Point2 avoiding(std::size_t place, const Point2& preferred, double dt,
                  std::span<const CrowdRobot> robots);
  void move(Member& member, double dt);
  void show();
  const HerdModel& herd(AgentKind kind) const {
    return kind == AgentKind::kCattle ? config_.cattle : config_.sheep;
  }

  CrowdConfig config_;
  std::vector<Member> members_;
  std::vector<Agent> seen_;
  OrcaObstacles obstacles_;
  GoalRule goals_;
  RandomStream goal_stream_;
  RandomStream nudge_stream_;
  RandomStream herd_stream_;
  double time_s_ = 0.0;
  int next_id_ = 0;

  // Of the step at hand.
  std::vector<std::size_t> here_;    // members who are there; their places are what follows
  std::vector<Point2> positions_;    // of these
  Neighbors neighbors_;              // of these
  std::vector<HerdBody> frightful_;  // whom animals flee from
  std::vector<HerdBody> flock_;
  std::vector<HerdThreat> threats_;
  std::vector<VelocityLine> lines_;
  std::vector<VelocityLine> scratch_;
};

}  // namespace headland

template <>
struct headland::config::EnumNames<headland::Behaviour> {
  static constexpr std::pair<headland::Behaviour, std::string_view> values[] = {
      {headland::Behaviour::kOrca, "orca"},
      {headland::Behaviour::kOrcaBlind, "orca_blind"},
      {headland::Behaviour::kIgnore, "ignore"},
      {headland::Behaviour::kHerd, "herd"},
      {headland::Behaviour::kReplay, "replay"}};
};
