// SPDX-License-Identifier: Apache-2.0
#include "local_planner/fail_safe/fail_safe.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kStill = Stopping::kStill;
constexpr double kHeldFor = 1.0;    // a held steering is forgotten after so long unused [s]
constexpr int kBisections = 7;      // of the allowed speed: to 1 % of the wanted one
constexpr double kCrawl = 0.05;     // slower is not worth driving [m/s]
constexpr double kMovesAway = 0.1;  // share of the speed with which the outline leaves someone

// Of the way under way [1/m]; 0 at a stand.
double curvature_of(const VehicleState& state) {
  return std::abs(state.speed) > kStill ? state.yaw_rate / state.speed : 0.0;
}

bool is_finite(const Command& command) {
  return std::isfinite(command.speed) && std::isfinite(command.steering) &&
         std::isfinite(command.yaw_rate);
}

}  // namespace

FailSafe::FailSafe(const Vehicle& vehicle, const FailSafeConfig& config)
    : vehicle_(vehicle),
      config_(config),
      discs_(vehicle.footprint),
      disc_(vehicle.footprint),
      reaction_(std::max(config.reaction_time_s, config.cycle_s) + vehicle.speed_dead_time_s) {}

SafeCommand FailSafe::limit(const LocalScene& scene, const Command& wanted) {
  const VehicleState& state = scene.robot.state;
  const bool numbers = is_finite(state) && is_finite(wanted) && std::isfinite(scene.time_s) &&
                       !std::isnan(scene.age_s) &&
                       std::all_of(scene.agents.begin(), scene.agents.end(),
                                   [](const Agent& agent) { return headland::is_finite(agent); });
  if (!numbers) return stop(state, SafetyReason::kBadInput);
  if (scene.age_s > config_.max_age_s) return stop(state, SafetyReason::kStale);

  const bool rolls = std::abs(state.speed) > kStill;
  const double direction = (rolls ? state.speed : wanted.speed) < 0.0 ? -1.0 : 1.0;
  const Turn turn = turn_of(wanted, state);
  const double now = turn.on_the_spot ? 0.0 : std::max(0.0, direction * state.speed);
  const double asked =
      turn.on_the_spot ? std::abs(turn.rate) : std::max(0.0, direction * wanted.speed);
  const double cap = std::max(now, asked);
  SafeCommand out{wanted, cap, SafetyReason::kNone, -1, 1e3};
  find_near(scene, cap, turn.on_the_spot, out);

  Allowed most = allowed(scene, turn, direction, cap);
  if (out.gap < config_.near_m && most.speed > config_.near_speed_mps &&
      !leaves(scene, turn, direction, out.nearest)) {
    most = {config_.near_speed_mps, {false, SafetyReason::kNear, out.nearest}};
  }
  Turn driven = turn;
  if (most.speed < now) {
    // Too fast for this turn: on along the last one that was certified. Is it too fast for that as
    // well, it is the one whose stop was certified before.
    driven = held_turn(scene);
    const Allowed otherwise = allowed(scene, driven, direction, now);
    if (otherwise.speed < now) most.speed = std::min(most.speed, otherwise.speed);
  }
  held_ = driven;
  held_at_ = scene.time_s;
  if (most.speed >= cap) {
    if (rolls && stops_first(wanted, direction)) {
      out.command = command(state, driven, direction, 0.0);
    }
    return out;
  }
  out.command = command(state, driven, direction, std::min(asked, most.speed));
  out.allowed_speed = most.speed;
  out.reason = most.why.reason;
  if (most.why.agent >= 0) out.nearest = most.why.agent;
  return out;
}

// Whether a rolling vehicle has to stand before it does what is wanted: another gear, or turning on
// the spot.
bool FailSafe::stops_first(const Command& wanted, double direction) const {
  return direction * wanted.speed < 0.0 ||
         (vehicle_.steering == Steering::kDifferential && std::abs(wanted.speed) < kStill);
}

Turn FailSafe::turn_of(const Command& wanted, const VehicleState& state) const {
  Turn turn;
  turn.steering = wanted.steering;
  if (vehicle_.steering == Steering::kAckermann) return turn;
  const bool rolls = std::abs(state.speed) > kStill;
  if (rolls && stops_first(wanted, state.speed)) {
    turn.curvature = curvature_of(state);
  } else if (std::abs(wanted.speed) >= kStill) {
    turn.curvature = wanted.yaw_rate / wanted.speed;
  } else if (std::abs(wanted.yaw_rate) > 0.0) {
    turn.on_the_spot = true;
    turn.rate = wanted.yaw_rate;
  }
  return turn;
}

// The turn of the last certified command; after a pause, the one under way.
Turn FailSafe::held_turn(const LocalScene& scene) const {
  const bool recent = scene.time_s - held_at_ <= kHeldFor && scene.time_s >= held_at_;
  if (recent && !held_.on_the_spot) return held_;
  const VehicleState& state = scene.robot.state;
  return {false, state.steering, curvature_of(state), 0.0};
}

// Who may matter at `cap`, and the nearest of all.
void FailSafe::find_near(const LocalScene& scene, double cap, bool on_the_spot, SafeCommand& out) {
  const Pose2& pose = scene.robot.state.pose;
  const Pose2 T_base_map = inverse(pose);
  const Stopping stopping = stop_of(on_the_spot, cap);
  const double time = stopping.duration() + std::max(0.0, scene.age_s);
  // The disc's centre goes as far as the base, and around it.
  const double reach =
      disc_.radius + 2.0 * std::abs(disc_.ahead) + (on_the_spot ? 0.0 : stopping.distance());
  near_.clear();
  for (std::size_t i = 0; i < scene.agents.size(); ++i) {
    const Agent& agent = scene.agents[i];
    const Point2 p_base = T_base_map * agent.position;
    const double gap = outline_distance(vehicle_.footprint, p_base) - agent.radius_m;
    if (gap < out.gap) {
      out.gap = gap;
      out.nearest = static_cast<int>(i);
    }
    const double far = (p_base - Point2(disc_.ahead, 0.0)).norm() - touch_radius(agent);
    if (far <= reach + fastest(agent) * time) near_.push_back(static_cast<int>(i));
  }
}

Stopping FailSafe::stop_of(bool on_the_spot, double speed) const {
  return on_the_spot
             ? Stopping(reaction_, vehicle_.yaw_acceleration_radps2, vehicle_.steering_lag_s, speed)
             : Stopping(reaction_, vehicle_.acceleration_mps2, vehicle_.speed_lag_s, speed);
}

double FailSafe::fastest(const Agent& agent) const {
  return std::max(config_.agent_speed_mps, agent.velocity.norm());
}

double FailSafe::touch_radius(const Agent& agent) const {
  return agent.radius_m + config_.allowances() + config_.noise_ratio * agent.noise_m;
}

// Whether someone may get to an edge that moves outwards before the robot stands.
bool FailSafe::may_touch(const Sweep& sweep, const Agent& agent, double age) const {
  const double radius = touch_radius(agent);
  const double worst = fastest(agent);
  // Where it was seen, before what follows has it walk through the robot.
  if (sweep.stations().front().way_to_touch(agent.position, radius) <= 0.0) return true;
  for (const Station& station : sweep.stations()) {
    const double time = station.time + age;
    if (station.way_to_touch(agent.position, radius) > worst * time) continue;
    if (config_.agents == AgentMotion::kWorstCase) return true;
    const Point2 there = agent.position + time * agent.velocity;
    const double aside = 0.5 * config_.agent_acceleration_mps2 * time * time;
    // Who would walk through the robot stands at its edge, nobody knows which.
    if (station.way_to_touch(there, radius) <= aside || station.holds(there, vehicle_.footprint)) {
      return true;
    }
  }
  return false;
}

FailSafe::Verdict FailSafe::check(const LocalScene& scene, const Turn& turn, double direction,
                                  double speed) {
  const VehicleState& state = scene.robot.state;
  const Sweep sweep(vehicle_, state, turn, direction, speed, stop_of(turn.on_the_spot, speed));
  if (scene.map != nullptr && !scene.map->empty()) {
    // Leaving an obstacle is always allowed.
    const double least = std::min(0.0, discs_.free(*scene.map, state.pose));
    for (const Station& station : sweep.stations()) {
      if (discs_.free(*scene.map, station.pose) < least) {
        return {false, SafetyReason::kObstacle, -1};
      }
    }
  }
  const double age = std::max(0.0, scene.age_s);
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const int agent = near_[i];
    if (may_touch(sweep, scene.agents[static_cast<std::size_t>(agent)], age)) {
      std::swap(near_[i], near_.front());  // most likely in the way at other speeds too
      return {false, SafetyReason::kAgent, agent};
    }
  }
  return {};
}

// The fastest certified speed found by bisection, at most `cap`.
FailSafe::Allowed FailSafe::allowed(const LocalScene& scene, const Turn& turn, double direction,
                                    double cap) {
  if (cap <= 0.0) return {cap, {}};
  // Not even by creeping, slower than a sweep would notice, does it come where it must not.
  Verdict why = check(scene, turn, direction, std::max(cap, kCrawl));
  if (why.safe) return {cap, why};
  double low = 0.0;
  double high = cap;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    const Verdict verdict = check(scene, turn, direction, middle);
    if (verdict.safe) {
      low = middle;
    } else {
      high = middle;
      why = verdict;
    }
  }
  return {low < kCrawl ? 0.0 : low, why};
}

// Whether the outline moves away from someone where it is nearest to him.
bool FailSafe::leaves(const LocalScene& scene, const Turn& turn, double direction,
                      int agent) const {
  const VehicleState& state = scene.robot.state;
  const Point2 p_base =
      inverse(state.pose) * scene.agents[static_cast<std::size_t>(agent)].position;
  const Footprint& outline = vehicle_.footprint;
  const double half = 0.5 * outline.width_m;
  const Point2 edge(std::clamp(p_base.x(), -outline.rear_m, outline.front_m),
                    std::clamp(p_base.y(), -half, half));
  const double ahead = turn.on_the_spot ? 0.0 : direction;
  const double curvature = vehicle_.steering == Steering::kAckermann
                               ? std::tan(state.steering) / vehicle_.wheelbase_m
                               : turn.curvature;
  const double rate = turn.on_the_spot ? std::copysign(1.0, turn.rate) : direction * curvature;
  const Point2 velocity(ahead - rate * edge.y(), rate * edge.x());
  const Point2 towards = p_base - edge;
  return velocity.dot(towards) < -kMovesAway * towards.norm();
}

// Drives at `speed` in the direction under way, or slows down to it as fast as the vehicle can.
Command FailSafe::command(const VehicleState& state, const Turn& turn, double direction,
                          double speed) const {
  if (turn.on_the_spot) return {0.0, state.steering, std::copysign(speed, turn.rate)};
  const double now = std::max(0.0, direction * state.speed);
  // Seen through the lag; the vehicle's own limit is what bounds the braking.
  const double told =
      speed < now
          ? std::max(0.0, command_through_lag(speed, now, vehicle_.speed_lag_s, config_.cycle_s))
          : speed;
  const double next = step_speed(vehicle_, state.speed, direction * told, config_.cycle_s);
  return {direction * told, turn.steering, turn.curvature * next};
}

SafeCommand FailSafe::stop(const VehicleState& state, SafetyReason reason) const {
  SafeCommand out;
  out.reason = reason;
  if (!headland::is_finite(state)) return out;
  const Turn turn{false, state.steering, curvature_of(state), 0.0};
  out.command = command(state, turn, state.speed < 0.0 ? -1.0 : 1.0, 0.0);
  return out;
}

}  // namespace headland
