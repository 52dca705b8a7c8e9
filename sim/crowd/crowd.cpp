// SPDX-License-Identifier: Apache-2.0
#include "sim/crowd/crowd.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

bool is_finite(const CrowdAgent& agent) {
  return agent.position.allFinite() && agent.velocity.allFinite() && agent.goal.allFinite() &&
         std::isfinite(agent.radius_m) && std::isfinite(agent.speed_mps) &&
         std::isfinite(agent.max_speed_mps);
}

bool is_finite(const CrowdRobot& robot) {
  return robot.position.allFinite() && robot.velocity.allFinite() &&
         std::isfinite(robot.radius_m) && std::isfinite(robot.share);
}

Point2 cut_to(double length, const Point2& v) {
  const double norm = v.norm();
  return norm > length ? Point2(length / norm * v) : v;
}

bool gives_way(Behaviour behaviour) {
  return behaviour == Behaviour::kOrca || behaviour == Behaviour::kOrcaBlind;
}

// Agents at the very same place: which way each of a pair takes the other to be [m]. Opposite for
// the two, and not the same for all pairs.
Point2 apart(std::size_t self, std::size_t other) {
  const double angle = static_cast<double>((self + other) % 1000);
  const double side = self < other ? 1e-9 : -1e-9;
  return {side * std::cos(angle), side * std::sin(angle)};
}

}  // namespace

GoalRule goals_within(const Region& area) {
  Point2 low(0.0, 0.0);
  Point2 high(0.0, 0.0);
  bool first = true;
  for (const Polygon& polygon : area.polygons()) {
    for (const Point2& p : polygon.outer) {
      low = first ? p : Point2(low.cwiseMin(p));
      high = first ? p : Point2(high.cwiseMax(p));
      first = false;
    }
  }
  return [area, low, high](const CrowdAgent&, RandomStream& random) -> std::optional<Point2> {
    constexpr int kTries = 1000;
    for (int i = 0; i < kTries; ++i) {
      const double x = random.uniform(low.x(), high.x());
      const Point2 p(x, random.uniform(low.y(), high.y()));
      if (area.contains(p)) return p;
    }
    return std::nullopt;
  };
}

Crowd::Crowd(const CrowdConfig& config, std::vector<CrowdAgent> agents, OrcaObstacles obstacles,
             std::uint64_t seed, GoalRule goals)
    : config_(config),
      obstacles_(std::move(obstacles)),
      goals_(std::move(goals)),
      goal_stream_(seed, "crowd_goals"),
      nudge_stream_(seed, "crowd_nudges") {
  config_.max_neighbor_count = std::max(0, config_.max_neighbor_count);
  for (std::size_t i = 0; i < agents.size(); ++i) {
    CrowdAgent& agent = agents[i];
    if (!is_finite(agent)) continue;
    agent.radius_m = std::max(0.0, agent.radius_m);
    agent.speed_mps = std::max(0.0, agent.speed_mps);
    agent.max_speed_mps = std::max(0.0, agent.max_speed_mps);
    agent.velocity = cut_to(agent.max_speed_mps, agent.velocity);
    members_.push_back(agent);
    seen_.push_back(
        {static_cast<int>(i), agent.kind, agent.position, agent.velocity, agent.radius_m});
  }
  positions_.resize(members_.size());
  velocities_.resize(members_.size());
  near_.reserve(static_cast<std::size_t>(config_.max_neighbor_count));
  constexpr std::size_t kObstacleLines = 64;
  constexpr std::size_t kRobots = 16;
  const std::size_t most = kObstacleLines + kRobots + near_.capacity();
  lines_.reserve(most);
  scratch_.reserve(most);
}

void Crowd::step(double dt, std::span<const CrowdRobot> robots) {
  if (!(std::isfinite(dt) && dt > 0.0)) return;
  for (std::size_t i = 0; i < members_.size(); ++i) positions_[i] = members_[i].position;
  nearest_.build(positions_);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const CrowdAgent& agent = members_[i];
    const Point2 preferred = preferred_velocity(agent);
    velocities_[i] = gives_way(agent.behaviour) ? avoiding_velocity(i, preferred, dt, robots)
                                                : cut_to(agent.max_speed_mps, preferred);
    if (!velocities_[i].allFinite()) velocities_[i].setZero();
  }
  for (std::size_t i = 0; i < members_.size(); ++i) {
    CrowdAgent& agent = members_[i];
    agent.velocity = velocities_[i];
    agent.position += dt * agent.velocity;
    if (goals_ && (agent.goal - agent.position).norm() < config_.arrival_m) {
      agent.goal = goals_(agent, goal_stream_).value_or(agent.goal);
    }
    seen_[i].position = agent.position;
    seen_[i].velocity = agent.velocity;
  }
  time_s_ += dt;
}

// To the goal, slower in the last second.
Point2 Crowd::preferred_velocity(const CrowdAgent& agent) {
  constexpr double kSlowing = 1.0;  // [s]
  Point2 velocity = cut_to(agent.speed_mps, (agent.goal - agent.position) / kSlowing);
  if (config_.nudge_mps > 0.0) {
    velocity.x() += config_.nudge_mps * nudge_stream_.uniform(-1.0, 1.0);
    velocity.y() += config_.nudge_mps * nudge_stream_.uniform(-1.0, 1.0);
  }
  return velocity;
}

Point2 Crowd::avoiding_velocity(std::size_t self, const Point2& preferred, double dt,
                                std::span<const CrowdRobot> robots) {
  const CrowdAgent& agent = members_[self];
  lines_.clear();
  if (!obstacles_.empty()) {
    obstacles_.append_lines(agent.position, agent.velocity, agent.radius_m,
                            config_.obstacle_horizon_s, agent.max_speed_mps, lines_);
  }
  const std::size_t hard = lines_.size();
  if (agent.behaviour != Behaviour::kOrcaBlind) append_robot_lines(agent, dt, robots);
  append_neighbor_lines(self, dt);
  return permitted_velocity(lines_, hard, preferred, agent.max_speed_mps, scratch_);
}

void Crowd::append_neighbor_lines(std::size_t self, double dt) {
  const CrowdAgent& agent = members_[self];
  nearest_.find(agent.position, static_cast<int>(self), config_.neighbor_distance_m,
                static_cast<std::size_t>(config_.max_neighbor_count), near_);
  for (const Near& near : near_) {
    const auto index = static_cast<std::size_t>(near.index);
    const CrowdAgent& other = members_[index];
    OrcaNeighbor neighbor{other.position, other.velocity, agent.radius_m + other.radius_m};
    // Whoever does not give way leaves it all to the others.
    neighbor.share = gives_way(other.behaviour) ? 0.5 : 1.0;
    if (near.distance2 == 0.0) neighbor.position += apart(self, index);
    lines_.push_back(orca_line(agent.position, agent.velocity, neighbor, config_.horizon_s, dt));
  }
}

void Crowd::append_robot_lines(const CrowdAgent& agent, double dt,
                               std::span<const CrowdRobot> robots) {
  for (const CrowdRobot& robot : robots) {
    if (!is_finite(robot) || !(robot.share > 0.0)) continue;
    if ((robot.position - agent.position).norm() >= config_.neighbor_distance_m) continue;
    const double reach = agent.radius_m + std::max(0.0, robot.radius_m);
    lines_.push_back(orca_line(agent.position, agent.velocity,
                               {robot.position, robot.velocity, reach, std::min(robot.share, 1.0)},
                               config_.horizon_s, dt));
  }
}

}  // namespace headland
