// SPDX-License-Identifier: Apache-2.0
#include "local_planner/velocity_obstacle/velocity_obstacle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "local_planner/cost_to_go.hpp"
#include "local_planner/course.hpp"

namespace headland {
namespace {

constexpr double kStep = 0.1;          // of plans [s]
constexpr double kCommit = 0.5;        // what is driven before the next plan can stop it [s]
constexpr double kOverlapStep = 0.3;   // overlapping discs get free in so long [s]
constexpr double kReversePrice = 0.3;  // of all motions backwards [m/s]
constexpr double kImpatience = 0.5;    // price of standing per second beyond patience [m/s2]
constexpr double kPivotPrice = 0.1;    // [m/s]
constexpr double kPivotRate = 0.6;     // [rad/s]
constexpr double kStill = 0.05;        // [m/s]
constexpr double kLookahead = 1.0;     // of the pursuit [m]; and a second's travel
constexpr double kPathAccuracy = 0.5;  // of aims on the path [m]
constexpr int kArcs = 5;               // to each side; denser near straight on
constexpr std::array<double, 4> kSpeeds = {1.0, 0.7, 0.4, -0.4};  // of the wanted one
constexpr std::array<double, 4> kPursuits = {1.0, 0.75, 0.5, 0.25};

double det(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }

double curvature_of(const Vehicle& vehicle, const VehicleState& state) {
  if (vehicle.steering == Steering::kAckermann) {
    return std::tan(state.steering) / vehicle.wheelbase_m;
  }
  return std::abs(state.speed) > kStill ? state.yaw_rate / state.speed : 0.0;
}

// Of the outline's centre [m/s, map].
Point2 centre_velocity(const Vehicle& vehicle, const VehicleState& state, double ahead) {
  const double rate = vehicle.steering == Steering::kAckermann
                          ? state.speed * curvature_of(vehicle, state)
                          : state.yaw_rate;
  return state.speed * state.pose.heading() + rate * ahead * state.pose.left();
}

}  // namespace

VelocityObstacle::VelocityObstacle(const Vehicle& vehicle, const VelocityObstacleConfig& config)
    : LocalPlanner(vehicle),
      config_(config),
      discs_(vehicle.footprint),
      disc_(vehicle.footprint),
      steps_(static_cast<int>(std::ceil(std::max(config.length_s, config.mean_s) / kStep))) {}

// The half-planes of the nearest agents. Centres keep apart by the agent's radius and by what of
// the outline lies between them now.
void VelocityObstacle::find_lines(const LocalScene& scene) {
  const VehicleState& state = scene.robot.state;
  const Point2 centre = disc_.centre(state.pose);
  const Point2 velocity = centre_velocity(vehicle(), state, disc_.ahead);
  const Pose2 T_base_map = inverse(state.pose);
  near_.clear();
  for (std::size_t i = 0; i < scene.agents.size(); ++i) {
    const double distance = (scene.agents[i].position - centre).norm();
    if (distance < config_.view_m) near_.emplace_back(distance, i);
  }
  std::sort(near_.begin(), near_.end());
  near_.resize(std::min(near_.size(), static_cast<std::size_t>(config_.agents_count)));
  lines_.clear();
  for (const auto& [distance, i] : near_) {
    const Agent& agent = scene.agents[i];
    OrcaNeighbor other;
    other.position = agent.position + std::max(0.0, scene.age_s) * agent.velocity;
    other.velocity = agent.velocity;
    const double extent = (other.position - centre).norm() -
                          outline_distance(vehicle().footprint, T_base_map * other.position);
    other.reach_m = agent.radius_m + extent + config_.margin_m + agent.noise_m;
    other.share = config_.share_ratio;
    const VelocityLine line = orca_line(centre, velocity, other, config_.horizon_s, kOverlapStep);
    if (line.point.allFinite() && line.direction.allFinite()) lines_.push_back(line);
  }
}

// How far beyond the border that it crosses most [m/s].
double VelocityObstacle::violation(const Point2& velocity) const {
  double most = 0.0;
  for (const VelocityLine& line : lines_) {
    most = std::max(most, det(line.direction, line.point - velocity));
  }
  return most;
}

Point2 VelocityObstacle::mean_velocity(const LocalPlan& plan) const {
  const VehicleState then = plan.at(plan.begin_s + config_.mean_s);
  return (disc_.centre(then.pose) - disc_.centre(plan.states.front().pose)) / config_.mean_s;
}

// Of the way from here to the aim that the vehicle can drive in the aim's gear [m].
double VelocityObstacle::distance_from(const VehicleState& state) const {
  Pose2 pose = state.pose;
  if (aim_.gear == Gear::kReverse) pose.yaw = wrap_angle(pose.yaw + kPi);
  return forward_distance(pose, aim_.point, std::min(aim_.accuracy, kPathAccuracy),
                          vehicle().turning_radius());
}

// How much nearer to the aim a plan comes, along ways that the vehicle can drive [m/s].
double VelocityObstacle::progress(const LocalPlan& plan) const {
  const double end = plan.begin_s + config_.mean_s;
  return (distance_ - distance_from(plan.at(end))) / config_.mean_s;
}

void VelocityObstacle::pursue_path(const LocalScene& scene, const LocalGoal& goal, double speed) {
  begin_plan(scene, kStep, candidate_);
  Course course(goal);
  for (int i = 0; i < steps_; ++i) {
    const VehicleState& now = candidate_.states.back();
    const Aim aim = course.from(now, kLookahead + std::abs(now.speed));
    drive_on(vehicle(), pursue(vehicle(), now, aim, speed), candidate_);
  }
}

void VelocityObstacle::hold(const LocalScene& scene, const Motion& motion) {
  begin_plan(scene, kStep, candidate_);
  for (int i = 0; i < steps_; ++i) drive_on(vehicle(), motion, candidate_);
}

// Takes the candidate if it is better than the best so far, and clear.
void VelocityObstacle::consider(const LocalScene& scene, double extra, LocalPlan& best) {
  const Point2 velocity = mean_velocity(candidate_);
  candidate_.cost =
      config_.violation_weight * violation(velocity) + top_ - progress(candidate_) + extra;
  ++best.expansions;
  if (!best.states.empty() && candidate_.cost >= best.cost) return;
  if (!stays_clear(vehicle(), discs_, scene.map, candidate_, kCommit, scratch_)) return;
  candidate_.expansions = best.expansions;
  std::swap(best, candidate_);
}

void VelocityObstacle::consider_arcs(const LocalScene& scene, LocalPlan& best) {
  const VehicleState& state = scene.robot.state;
  const double standing = kImpatience * std::max(0.0, standstill_.duration() - config_.patience_s);
  hold(scene, {0.0, curvature_of(vehicle(), state), 0.0});
  consider(scene, standing, best);
  for (const double scale : kSpeeds) {
    if (scale < 0.0 && !vehicle().can_reverse) continue;
    const Gear gear = scale < 0.0 ? Gear::kReverse : Gear::kForward;
    for (int k = -kArcs; k <= kArcs; ++k) {
      const double share = static_cast<double>(k) / kArcs;
      const double curvature = tightest_curvature(vehicle()) * share * std::abs(share);
      const double speed = speed_within(vehicle(), std::abs(scale) * top_, gear, curvature);
      hold(scene, {sign(gear) * speed, curvature, 0.0});
      consider(scene, scale < 0.0 ? kReversePrice : 0.0, best);
    }
  }
  if (vehicle().steering == Steering::kDifferential) {
    for (const double rate : {-kPivotRate, kPivotRate}) {
      hold(scene, {0.0, 0.0, rate});
      consider(scene, kPivotPrice + standing, best);
    }
  }
}

void VelocityObstacle::do_plan(const LocalScene& scene, const LocalGoal& goal, const PlanBudget&,
                               LocalPlan& plan) {
  const VehicleState& state = scene.robot.state;
  standstill_.update(scene.time_s, state.speed);
  find_lines(scene);
  top_ = speed_within(vehicle(), goal.speed_mps, Gear::kForward, 0.0);
  aim_ = Course(goal).from(state, config_.lookahead_m);
  distance_ = distance_from(state);
  plan.states.clear();
  plan.expansions = 0;
  for (const double scale : kPursuits) {
    pursue_path(scene, goal, scale * top_);
    consider(scene, 0.0, plan);
  }
  consider_arcs(scene, plan);
  if (plan.states.empty()) {
    const bool stands = std::abs(state.speed) < kStill;
    brake(vehicle(), state, scene.time_s, stands ? LocalStatus::kBlocked : LocalStatus::kBraking,
          plan);
  }
}

}  // namespace headland
