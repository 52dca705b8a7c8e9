// SPDX-License-Identifier: Apache-2.0
#include "sim/crowd/crowd.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

bool is_finite(const CrowdAgent& agent) {
  return agent.position.allFinite() && agent.velocity.allFinite() && agent.goal.allFinite() &&
         std::isfinite(agent.radius_m) && std::isfinite(agent.speed_mps) &&
         std::isfinite(agent.max_speed_mps) && std::isfinite(agent.flight_m);
}

bool is_seen(const CrowdRobot& robot) {
  return robot.position.allFinite() && robot.velocity.allFinite() &&
         std::isfinite(robot.radius_m) && robot.share > 0.0;
}

Point2 cut_to(double length, const Point2& v) {
  const double norm = v.norm();
  return norm > length ? Point2(length / norm * v) : v;
}

bool is_livestock(AgentKind kind) {
  return kind == AgentKind::kSheep || kind == AgentKind::kCattle;
}

// Those of one way give way to each other, half and half; to all others each leaves nothing to do.
enum class Way { kNone, kWalking, kGrazing };
Way way(Behaviour behaviour) {
  if (behaviour == Behaviour::kHerd) return Way::kGrazing;
  const bool walks = behaviour == Behaviour::kOrca || behaviour == Behaviour::kOrcaBlind;
  return walks ? Way::kWalking : Way::kNone;
}

// Agents at the very same place: where each of a pair takes the other to be [m], as seen from
// itself. Opposite for the two, and not the same for all pairs.
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
      nudge_stream_(seed, "crowd_nudges"),
      herd_stream_(seed, "crowd_herds") {
  config_.max_neighbor_count = std::max(0, config_.max_neighbor_count);
  for (CrowdAgent& agent : agents) {
    const int id = next_id_++;
    if (!is_finite(agent) || agent.behaviour == Behaviour::kReplay) continue;
    if (agent.behaviour == Behaviour::kHerd) agent.max_speed_mps = herd(agent.kind).run_mps;
    if (agent.flight_m < 0.0) agent.flight_m = herd(agent.kind).flight_m;
    agent.radius_m = std::max(0.0, agent.radius_m);
    agent.speed_mps = std::max(0.0, agent.speed_mps);
    agent.max_speed_mps = std::max(0.0, agent.max_speed_mps);
    agent.velocity = cut_to(agent.max_speed_mps, agent.velocity);
    Member member{agent, id};
    const double angle = herd_stream_.uniform(-kPi, kPi);
    member.noise = {std::cos(angle), std::sin(angle)};
    members_.push_back(std::move(member));
  }
  constexpr std::size_t kObstacleLines = 64;
  constexpr std::size_t kRobots = 16;
  const auto most = static_cast<std::size_t>(config_.max_neighbor_count);
  lines_.reserve(kObstacleLines + kRobots + most);
  scratch_.reserve(kObstacleLines + kRobots + most);
  flock_.reserve(most);
  show();
}

void Crowd::replay(const TrackSet& tracks, const Pose2& T_map_tracks, double begin_s) {
  for (const Track& recorded : tracks.tracks) {
    Member member;
    member.track = recorded;
    for (double& time : member.track->time_s) time += begin_s;
    for (Point2& p : member.track->position) p = T_map_tracks * p;
    member.id = next_id_++;
    member.agent.kind = recorded.kind;
    member.agent.behaviour = Behaviour::kReplay;
    move(member, 0.0);
    members_.push_back(std::move(member));
  }
  show();
}

void Crowd::step(double dt, std::span<const CrowdRobot> robots) {
  if (!(std::isfinite(dt) && dt > 0.0)) return;
  look(robots);
  for (std::size_t place = 0; place < here_.size(); ++place) {
    const Point2 next = next_velocity(place, dt, robots);
    members_[here_[place]].next = next.allFinite() ? next : Point2(0.0, 0.0);
  }
  time_s_ += dt;
  for (Member& member : members_) move(member, dt);
  show();
}

// Who is there, who is near whom, and whom animals fear.
void Crowd::look(std::span<const CrowdRobot> robots) {
  here_.clear();
  positions_.clear();
  frightful_.clear();
  here_.reserve(members_.size());
  positions_.reserve(members_.size());
  frightful_.reserve(members_.size() + robots.size());
  threats_.reserve(members_.size() + robots.size());
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const CrowdAgent& agent = members_[i].agent;
    if (!members_[i].here) continue;
    here_.push_back(i);
    positions_.push_back(agent.position);
    if (!is_livestock(agent.kind)) frightful_.push_back({agent.position, agent.velocity});
  }
  for (const CrowdRobot& robot : robots) {
    if (is_seen(robot)) frightful_.push_back({robot.position, robot.velocity});
  }
  neighbors_.update(positions_, config_.neighbor_distance_m,
                    static_cast<std::size_t>(config_.max_neighbor_count));
}

Point2 Crowd::next_velocity(std::size_t place, double dt, std::span<const CrowdRobot> robots) {
  const CrowdAgent& agent = members_[here_[place]].agent;
  switch (agent.behaviour) {
    case Behaviour::kOrca:
    case Behaviour::kOrcaBlind:
      return avoiding(place, goal_velocity(agent), dt, robots);
    case Behaviour::kHerd:
      return avoiding(place, animal_velocity(place, dt), dt, robots);
    case Behaviour::kIgnore:
      return cut_to(agent.max_speed_mps, goal_velocity(agent));
    case Behaviour::kReplay:
      break;
  }
  return {0.0, 0.0};
}

// To the goal, slower in the last second.
Point2 Crowd::goal_velocity(const CrowdAgent& agent) {
  constexpr double kSlowing = 1.0;  // [s]
  Point2 velocity = cut_to(agent.speed_mps, (agent.goal - agent.position) / kSlowing);
  if (config_.nudge_mps > 0.0) {
    velocity.x() += config_.nudge_mps * nudge_stream_.uniform(-1.0, 1.0);
    velocity.y() += config_.nudge_mps * nudge_stream_.uniform(-1.0, 1.0);
  }
  return velocity;
}

Point2 Crowd::animal_velocity(std::size_t place, double dt) {
  Member& animal = members_[here_[place]];
  const HerdModel& model = herd(animal.agent.kind);
  flock_.clear();
  for (const Neighbor& near : neighbors_.of(place)) {
    const CrowdAgent& other = members_[here_[static_cast<std::size_t>(near.index)]].agent;
    if (other.kind == animal.agent.kind) flock_.push_back({other.position, other.velocity});
  }
  threats_.clear();
  for (const HerdBody& body : frightful_) {
    if ((body.position - animal.agent.position).norm() < animal.agent.flight_m) {
      threats_.push_back({body, animal.agent.flight_m});
    }
  }
  animal.noise = turned_noise(model, animal.noise, dt, herd_stream_);
  const HerdBody self{animal.agent.position, animal.agent.velocity};
  const Point2 wanted = herd_velocity(model, self, flock_, threats_, animal.noise);
  return respond(model, animal.agent.velocity, wanted, dt);
}

Point2 Crowd::avoiding(std::size_t place, const Point2& preferred, double dt,
                       std::span<const CrowdRobot> robots) {
  const CrowdAgent& agent = members_[here_[place]].agent;
  const bool grazes = agent.behaviour == Behaviour::kHerd;
  const double horizon = grazes ? config_.contact_horizon_s : config_.horizon_s;
  const auto avoid = [&](const OrcaNeighbor& other) {
    lines_.push_back(orca_line(agent.position, agent.velocity, other, horizon, dt));
  };
  lines_.clear();
  if (!obstacles_.empty()) {
    obstacles_.append_lines(agent.position, agent.velocity, agent.radius_m,
                            config_.obstacle_horizon_s, agent.max_speed_mps, lines_);
  }
  const std::size_t hard = lines_.size();
  for (const CrowdRobot& robot : robots) {
    if (agent.behaviour == Behaviour::kOrcaBlind || !is_seen(robot)) continue;
    const double distance = (robot.position - agent.position).norm();
    if (!(distance < config_.neighbor_distance_m)) continue;
    const double reach = agent.radius_m + std::max(0.0, robot.radius_m);
    avoid({robot.position, robot.velocity, reach, std::min(robot.share, 1.0)});
  }
  for (const Neighbor& near : neighbors_.of(place)) {
    const auto other_place = static_cast<std::size_t>(near.index);
    const CrowdAgent& other = members_[here_[other_place]].agent;
    Point2 position = other.position;
    if (near.distance2 == 0.0) position += apart(place, other_place);
    const double share = way(other.behaviour) == way(agent.behaviour) ? 0.5 : 1.0;
    avoid({position, other.velocity, agent.radius_m + other.radius_m, share});
  }
  return permitted_velocity(lines_, hard, preferred, agent.max_speed_mps, scratch_);
}

void Crowd::move(Member& member, double dt) {
  CrowdAgent& agent = member.agent;
  if (member.track) {
    const auto recorded = member.track->at(time_s_);
    member.here = recorded.has_value();
    if (!recorded) return;
    agent.position = recorded->position;
    agent.velocity = recorded->velocity;
    agent.radius_m = recorded->radius_m;
    return;
  }
  agent.velocity = member.next;
  const Point2 position = agent.position + dt * agent.velocity;
  if (position.allFinite()) agent.position = position;
  if (goals_ && agent.behaviour != Behaviour::kHerd &&
      (agent.goal - agent.position).norm() < config_.arrival_m) {
    const Point2 goal = goals_(agent, goal_stream_).value_or(agent.goal);
    if (goal.allFinite()) agent.goal = goal;
  }
}

void Crowd::show() {
  seen_.clear();
  seen_.reserve(members_.size());
  for (const Member& member : members_) {
    if (!member.here) continue;
    const CrowdAgent& agent = member.agent;
    seen_.push_back({member.id, agent.kind, agent.position, agent.velocity, agent.radius_m});
  }
}

}  // namespace headland
