// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/prediction/wandering_robot.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/model/orca.hpp"

namespace headland {
namespace {

constexpr double kTurnGain = 1.5;     // yaw rate per error of heading [1/s]
constexpr double kTurnSpeed = 0.3;    // it turns as if it were at least as fast [m/s]
constexpr double kEvasionTime = 4.0;  // [s]
constexpr double kClearance = 0.3;    // that it keeps when it drives around people [m]

const Agent* nearest(std::span<const Agent> agents, const Point2& position) {
  const auto found =
      std::min_element(agents.begin(), agents.end(), [&](const Agent& a, const Agent& b) {
        return (a.position - position).squaredNorm() < (b.position - position).squaredNorm();
      });
  return found == agents.end() ? nullptr : &*found;
}

}  // namespace

WanderingRobot::WanderingRobot(double reach, double radius, std::uint64_t seed)
    : random_(seed, "wandering_robot"), reach_m_(reach), radius_m_(radius) {
  top_speed_ = random_.uniform(0.5, 2.0);
  acceleration_ = random_.uniform(0.4, 1.5);
  curvature_ = random_.uniform(0.2, 1.0);
  position_ = {random_.uniform(-reach, reach), random_.uniform(-reach, reach)};
  yaw_ = random_.uniform(-kPi, kPi);
  choose_way();
}

Point2 WanderingRobot::velocity() const {
  return {speed_ * std::cos(yaw_), speed_ * std::sin(yaw_)};
}

void WanderingRobot::choose_way() {
  constexpr Way kWays[] = {Way::kStraight, Way::kStraight, Way::kPlace,   Way::kPlace,
                           Way::kAround,   Way::kAround,   Way::kTowards, Way::kTowards,
                           Way::kStanding, Way::kBacking};
  way_ = kWays[random_.index(10)];
  left_s_ = random_.uniform(1.5, 7.0);
  wish_ = top_speed_ * random_.uniform(0.4, 1.0);
  place_ = {random_.uniform(-reach_m_, reach_m_), random_.uniform(-reach_m_, reach_m_)};
  // Far out, it comes back.
  if (position_.norm() > reach_m_ && way_ != Way::kStanding) way_ = Way::kPlace;
}

Point2 WanderingRobot::wanted_velocity(std::span<const Agent> agents) const {
  const Point2 ahead(std::cos(yaw_), std::sin(yaw_));
  const auto to = [&](const Point2& place) {
    const Point2 offset = place - position_;
    return Point2(offset * (wish_ / std::max(offset.norm(), 0.5)));
  };
  switch (way_) {
    case Way::kStraight:
      return wish_ * ahead;
    case Way::kPlace:
      return to(place_);
    case Way::kTowards: {
      const Agent* agent = nearest(agents, position_);
      return agent == nullptr ? to(place_) : to(agent->position + agent->velocity);
    }
    case Way::kAround: {
      std::vector<VelocityLine> lines;
      std::vector<VelocityLine> scratch;
      for (const Agent& agent : agents) {
        if ((agent.position - position_).norm() > 8.0) continue;
        const OrcaNeighbor other{agent.position, agent.velocity,
                                 agent.radius_m + radius_m_ + kClearance, 0.5};
        lines.push_back(orca_line(position_, velocity(), other, kEvasionTime, 0.1));
      }
      return permitted_velocity(lines, 0, to(place_), top_speed_, scratch);
    }
    case Way::kBacking:
      return -0.5 * wish_ * ahead;
    case Way::kStanding:
      break;
  }
  return {0.0, 0.0};
}

void WanderingRobot::step(double dt, std::span<const Agent> agents) {
  left_s_ -= dt;
  if (left_s_ < 0.0) choose_way();
  const Point2 wanted = wanted_velocity(agents);
  double target = wanted.norm();
  double turn = 0.0;
  if (way_ == Way::kBacking) {
    target = -target;
  } else if (target > 1e-3) {
    const double error = wrap_angle(std::atan2(wanted.y(), wanted.x()) - yaw_);
    target *= std::max(0.2, std::cos(error));
    const double most = curvature_ * std::max(std::abs(speed_), kTurnSpeed);
    turn = std::clamp(kTurnGain * error, -most, most);
  }
  speed_ += std::clamp(target - speed_, -acceleration_ * dt, acceleration_ * dt);
  yaw_ = wrap_angle(yaw_ + turn * dt);
  position_ += dt * velocity();
}

}  // namespace headland
