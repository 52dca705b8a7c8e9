// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/run/local_layer.hpp"

#include <algorithm>
#include <cmath>

#include "local_planner/outline.hpp"
#include "local_planner/rollout.hpp"
#include "sim/crowd/sight.hpp"

namespace headland {
namespace {

constexpr double kStill = 0.05;     // slower, the vehicle is not at fault [m/s]
constexpr double kApart = 3.0;      // farther apart, a meeting is over [m]
constexpr double kSameTick = 1e-6;  // [s]

}  // namespace

LocalLayer::LocalLayer(const Vehicle& vehicle, const LocalLayerConfig& config,
                       const PredictorFactory& predictor, const ClearanceMap& map,
                       std::uint64_t seed, double cycle)
    : vehicle_(vehicle),
      config_(config),
      map_(map),
      cycle_(cycle),
      planner_(make_local_planner(config.planner, config.planners, vehicle, predictor)),
      arbiter_(vehicle, config.arbiter),
      fail_safe_(vehicle,
                 [&] {
                   FailSafeConfig own = config.fail_safe;
                   own.cycle_s = cycle;
                   return own;
                 }()),
      noise_(seed, "run/sight") {}

// A sight every period; between them, and while sight is lost, it ages.
void LocalLayer::look(double time, const VehicleEstimate& known, std::span<const Agent> agents) {
  const SightConfig& sight = config_.sight;
  const bool lost = time >= sight.lost_from_s && time < sight.lost_until_s;
  if (!lost && time - seen_at_ >= sight.period_s - kSameTick) {
    seen_at_ = time;
    see_agents(agents, known.state.pose.position(), sight.view_m, sight.noise_ratio, noise_, seen_);
  }
  scene_.time_s = time;
  scene_.robot = known;
  scene_.agents = seen_;
  scene_.age_s = time - seen_at_;
}

void LocalLayer::plan(double time, const LocalGoal& goal) {
  if (time - planned_at_ < config_.plan_period_s - kSameTick) return;
  planned_at_ = time;
  planner_->plan(scene_, goal, {config_.iterations_count, {}}, plan_);
}

LocalOutput LocalLayer::step(double time, const VehicleEstimate& known, const LocalGoal& goal,
                             const ArbiterView& view, std::span<const Agent> agents) {
  look(time, known, agents);
  const bool fresh = scene_.age_s < kSameTick;
  LocalOutput output;
  const Driving before = arbiter_.driving();
  output.driving = fresh ? arbiter_.decide(scene_, goal, view) : before;
  output.gave_back = before == Driving::kLocal && output.driving == Driving::kPath;
  // The path was checked against the map; what drives around agents has to see it.
  scene_.map = output.driving == Driving::kLocal ? &map_ : nullptr;
  if (fresh) planner_->observe(scene_);
  metrics_.takeovers = arbiter_.takeovers();
  if (output.driving == Driving::kPath) {
    planned_at_ = -1e9;
    return output;
  }
  metrics_.local_s += cycle_;
  plan(time, goal);
  output.command = guard(command_along(vehicle_, known.state, plan_, time, cycle_));
  return output;
}

Command LocalLayer::guard(const Command& wanted) {
  const SafeCommand safe = fail_safe_.limit(scene_, wanted);
  const bool held = safe.reason != SafetyReason::kNone;
  if (held) metrics_.held_s += cycle_;
  const bool stops = held && std::abs(safe.command.speed) < kStill &&
                     std::abs(safe.command.yaw_rate) < kStill &&
                     std::abs(scene_.robot.state.speed) < kStill;
  if (stops && !stopped_) ++metrics_.protective_stops;
  stopped_ = stops;
  return safe.command;
}

void LocalLayer::count(const VehicleState& truth, std::span<const Agent> agents) {
  const Pose2 T_base_map = inverse(truth.pose);
  for (const Agent& agent : agents) {
    const Point2 p_base = T_base_map * agent.position;
    const double gap = outline_distance(vehicle_.footprint, p_base) - agent.radius_m;
    if (gap > kApart) {
      meetings_.erase(agent.id);
      continue;
    }
    metrics_.least_gap_m = std::min(metrics_.least_gap_m, gap);
    Meeting& meeting = meetings_[agent.id];
    const bool near = gap < config_.near_m && !meeting.near;
    const bool contact = gap < 0.0 && !meeting.contact;
    if (!near && !contact) continue;
    const double by_vehicle = outline_closing(vehicle_, truth, agent.position);
    const Point2 towards = (agent.position - truth.pose.position()).normalized();
    const bool fault = by_vehicle > kStill;
    if (near) {
      meeting.near = true;
      ++metrics_.near_collisions;
      if (fault && by_vehicle >= -agent.velocity.dot(towards)) ++metrics_.robot_near;
    }
    if (contact) {
      meeting.contact = true;
      ++metrics_.collisions;
      if (fault) ++metrics_.robot_collisions;
    }
  }
}

}  // namespace headland
