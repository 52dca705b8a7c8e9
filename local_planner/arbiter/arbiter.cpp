// SPDX-License-Identifier: Apache-2.0
#include "local_planner/arbiter/arbiter.hpp"

#include <algorithm>
#include <cmath>

namespace headland {
namespace {

constexpr double kStep = 0.2;    // of the look ahead [s]
constexpr double kBehind = 3.0;  // the path is searched this far back for the vehicle [m]
constexpr double kAhead = 3.0;   // ... and ahead
constexpr double kWidens = 4.0;  // a free path is taken up from twice as far after so long [s] ...
constexpr double kWidest = 6.0;  // ... and at most this many times
constexpr double kPause = 1.0;   // after this, what held before is forgotten [s]

// Notes since when something holds at `time` [s].
void note(bool holds, double time, std::optional<double>& since) {
  if (!holds) {
    since.reset();
  } else if (!since) {
    since = time;
  }
}

}  // namespace

Arbiter::Arbiter(const Vehicle& vehicle, const ArbiterConfig& config)
    : vehicle_(vehicle), config_(config) {}

double Arbiter::wait(double spare_ratio) const {
  if (config_.scarce_ratio <= 0.0) return 0.0;
  const double scarce = std::clamp(1.0 - spare_ratio / config_.scarce_ratio, 0.0, 1.0);
  const double sparse = std::clamp(1.0 - density_ / config_.dense_per_m2, 0.0, 1.0);
  return config_.wait_s * scarce * sparse;
}

// Drives along the path at the wanted speed, as if nobody were there, and sees who comes near. From
// a stand too: that the fail-safe holds the vehicle does not clear the path.
void Arbiter::look_along(const LocalScene& scene, const LocalGoal& goal) {
  const Path& path = *goal.path;
  const double end = goal.place_s > goal.s ? std::min(goal.place_s, path.length()) : path.length();
  ahead_.begin_s = scene.time_s;
  ahead_.step_s = kStep;
  ahead_.states.clear();
  const int steps = static_cast<int>(std::ceil(config_.horizon_s / kStep));
  for (int i = 0; i <= steps; ++i) {
    const double s = std::min(end, goal.s + goal.speed_mps * kStep * i);
    ahead_.states.push_back({path.at(s).pose, goal.speed_mps, 0.0, 0.0});
  }
  gap_ = nearest_approach(vehicle_.footprint, scene, ahead_).gap;
  const Point2 here = scene.robot.state.pose.position();
  const auto near = std::count_if(scene.agents.begin(), scene.agents.end(), [&](const Agent& a) {
    return (a.position - here).norm() < config_.density_radius_m;
  });
  density_ =
      static_cast<double>(near) / (kPi * config_.density_radius_m * config_.density_radius_m);
}

bool Arbiter::back_on_path(const LocalScene& scene, const LocalGoal& goal) const {
  const Pose2& pose = scene.robot.state.pose;
  const Projection on = goal.path->project(pose.position(), goal.s - kBehind, goal.s + kAhead);
  const double off_heading = wrap_angle(pose.yaw - goal.path->at(on.s).pose.yaw);
  // The longer the path has been free, the farther off it may be taken up.
  const double free_for = scene.time_s - *free_since_ - config_.hold_s;
  const double wider = std::min(1.0 + free_for / kWidens, kWidest);
  return on.distance <= wider * config_.rejoin_m &&
         std::abs(off_heading) <= deg_to_rad(wider * config_.rejoin_deg);
}

Driving Arbiter::decide(const LocalScene& scene, const LocalGoal& goal, const ArbiterView& view) {
  if (!is_finite(scene, goal) || !(goal.speed_mps > 0.0) ||
      scene.age_s > LocalPlanner::kOldestScene) {
    return driving_;
  }
  if (goal.path == nullptr || goal.path->empty()) return driving_ = Driving::kLocal;
  look_along(scene, goal);
  if (!(scene.time_s >= looked_s_ && scene.time_s - looked_s_ <= kPause)) {
    in_way_since_.reset();
    free_since_.reset();
  }
  looked_s_ = scene.time_s;
  note(gap_ < config_.take_m, scene.time_s, in_way_since_);
  note(gap_ >= config_.give_m, scene.time_s, free_since_);
  const auto held = [&](const std::optional<double>& since, double duration) {
    return since && scene.time_s - *since >= duration - 1e-9;
  };
  if (driving_ == Driving::kPath) {
    if (held(in_way_since_, wait(view.spare_ratio)) && view.may_leave) {
      driving_ = Driving::kLocal;
      ++takeovers_;
    }
  } else if (held(free_since_, config_.hold_s) && back_on_path(scene, goal)) {
    driving_ = Driving::kPath;
  }
  return driving_;
}

}  // namespace headland
