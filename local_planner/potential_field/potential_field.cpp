// SPDX-License-Identifier: Apache-2.0
#include "local_planner/potential_field/potential_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace headland {
namespace {

constexpr double kStep = 0.1;      // of plans [s]
constexpr double kCommit = 0.5;    // what is driven before the next plan can stop it [s]
constexpr double kStill = 0.05;    // [m/s]
constexpr double kPush = 0.02;     // less is no push: the path is followed exactly
constexpr double kCell = 0.2;      // the slope of the clearance is taken over this [m]
constexpr double kTurnGain = 2.0;  // of the differential vehicle's turning [1/s]
constexpr double kTurnRate = 1.5;  // [rad/s]
constexpr double kFarWall = 5.0;   // [m]
constexpr std::array<double, 3> kSpeeds = {1.0, 0.5, 0.25};  // of the wanted one

// From the nearest point of the outline to a place [m, base]; from its middle if the place is
// inside.
Point2 from_outline(const Footprint& outline, const Point2& place, double middle) {
  const Point2 nearest(std::clamp(place.x(), -outline.rear_m, outline.front_m),
                       std::clamp(place.y(), -0.5 * outline.width_m, 0.5 * outline.width_m));
  const Point2 off = place - nearest;
  return off.squaredNorm() > 1e-12 ? off : Point2(place - Point2(middle, 0.0));
}

Point2 unit(const Point2& vector, const Point2& otherwise) {
  const double length = vector.norm();
  return length > 1e-9 ? Point2(vector / length) : otherwise;
}

}  // namespace

PotentialField::PotentialField(const Vehicle& vehicle, const PotentialFieldConfig& config)
    : LocalPlanner(vehicle), config_(config), discs_(vehicle.footprint), disc_(vehicle.footprint) {}

// Agents near a state that is driven through `ahead_s` from now; those of the seed's field stand.
void PotentialField::find_sources(const LocalScene& scene, const VehicleState& state,
                                  double ahead_s) {
  const Footprint& outline = vehicle().footprint;
  const Pose2 T_base_map = inverse(state.pose);
  const bool moves = config_.form == PotentialForm::kVelocity;
  const double age = std::max(0.0, scene.age_s) + (moves ? ahead_s : 0.0);
  sources_.clear();
  for (const Agent& agent : scene.agents) {
    const Point2 place = T_base_map * Point2(agent.position + age * agent.velocity);
    if (!(place.squaredNorm() < config_.view_m * config_.view_m)) continue;
    PotentialSource& source = sources_.emplace_back();
    source.gap = outline_distance(outline, place) - agent.radius_m - agent.noise_m;
    const Point2 towards = unit(from_outline(outline, place, disc_.ahead), Point2(1.0, 0.0));
    source.towards = towards.x() * state.pose.heading() + towards.y() * state.pose.left();
    source.velocity = agent.velocity;
  }
  if (scene.map != nullptr && !scene.map->empty()) add_obstacle(*scene.map, state);
}

void PotentialField::add_obstacle(const ClearanceMap& map, const VehicleState& state) {
  const double gap = discs_.free(map, state.pose);
  if (gap > kFarWall) return;
  const Point2 here = disc_.centre(state.pose);
  const auto slope = [&](const Point2& axis) {
    return map.clearance(here - kCell * axis) - map.clearance(here + kCell * axis);
  };
  const Point2 towards(slope({1.0, 0.0}), slope({0.0, 1.0}));
  if (towards.squaredNorm() < 1e-12) return;
  sources_.push_back({gap, towards.normalized(), {0.0, 0.0}});
}

Point2 PotentialField::repulsion(const VehicleState& state, const Point2& to_aim) const {
  const Point2 pull = unit(to_aim, state.pose.heading());
  if (config_.form == PotentialForm::kSeed) {
    return config_.seed.push(sources_, to_aim.norm(), config_.swirl_ratio, pull);
  }
  const Point2 velocity = state.speed * state.pose.heading();
  return config_.velocity.push(sources_, velocity, config_.swirl_ratio, pull);
}

// Towards a force: a differential vehicle turns while it drives.
Motion PotentialField::turn_to(const VehicleState& state, const Aim& aim, double speed) const {
  const Motion motion = pursue(vehicle(), state, aim, speed);
  if (vehicle().steering != Steering::kDifferential) return motion;
  const Point2 p = inverse(state.pose) * aim.point;
  const double off = std::atan2(sign(aim.gear) * p.y(), sign(aim.gear) * p.x());
  const double pivot = std::clamp(kTurnGain * off, -kTurnRate, kTurnRate);
  return {
      sign(aim.gear) * speed_within(vehicle(), speed, aim.gear, 0.0) * std::max(0.0, std::cos(off)),
      0.0, pivot};
}

void PotentialField::roll_out(const LocalScene& scene, const LocalGoal& goal, double speed,
                              LocalPlan& plan) {
  begin_plan(scene, kStep, plan);
  Course course(goal);
  const int steps = static_cast<int>(std::ceil(config_.length_s / kStep));
  for (int i = 0; i < steps; ++i) {
    const VehicleState& now = plan.states.back();
    find_sources(scene, now, kStep * i);
    Aim aim = course.from(now, config_.lookahead_m);
    const Point2 to_aim = aim.point - now.pose.position();
    const Point2 push = repulsion(now, to_aim);
    if (push.norm() > kPush) {
      const Point2 force = unit(to_aim, now.pose.heading()) + push;
      aim.point = now.pose.position() + std::max(1.0, to_aim.norm()) * unit(force, push);
      aim.accuracy = Aim{}.accuracy;  // a direction
      const double share = std::clamp(1.0 + sign(aim.gear) * push.dot(now.pose.heading()),
                                      config_.least_speed_ratio, 1.0);
      drive_on(vehicle(), turn_to(now, aim, share * speed), plan);
    } else {
      aim = course.from(now, 1.0 + std::abs(now.speed));
      drive_on(vehicle(), pursue(vehicle(), now, aim, speed), plan);
    }
  }
}

void PotentialField::do_plan(const LocalScene& scene, const LocalGoal& goal, const PlanBudget&,
                             LocalPlan& plan) {
  const VehicleState& state = scene.robot.state;
  int expansions = 0;
  for (const double scale : kSpeeds) {
    roll_out(scene, goal, scale * goal.speed_mps, plan);
    plan.expansions = expansions += static_cast<int>(plan.states.size());
    if (stays_clear(vehicle(), discs_, scene.map, plan, kCommit, scratch_)) return;
  }
  const bool stands = std::abs(state.speed) < kStill;
  brake(vehicle(), state, scene.time_s, stands ? LocalStatus::kBlocked : LocalStatus::kBraking,
        plan);
}

}  // namespace headland
