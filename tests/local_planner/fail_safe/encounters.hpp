// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <string_view>
#include <vector>

#include "core/base/random.hpp"
#include "core/model/command_delay.hpp"
#include "local_planner/fail_safe/fail_safe.hpp"

namespace headland::test {

/// How someone behaves towards a robot.
enum class Behavior {
  kStands,        ///< in or beside its way
  kStraight,      ///< walks somewhere, past it
  kCrosses,       ///< its way, so as to meet it
  kCrossesStops,  ///< likewise, and stops there
  kTurnsTowards,  ///< walks beside it and turns in front of it
  kRunsAtRobot,   ///< all the time
  kFromBehind,    ///< overtakes it and cuts in
  kErratic        ///< another direction and speed every half second
};
inline constexpr int kBehaviors = 8;
inline constexpr std::array<std::string_view, kBehaviors> kBehaviorNames = {
    "stands",        "straight",      "crosses",     "crosses and stops",
    "turns towards", "runs at robot", "from behind", "erratic"};

/// What came of an encounter.
struct Encounter {
  double worst_closing = 0.0;  ///< fastest that the outline moved towards someone it touched [m/s]
  bool touched = false;        ///< somebody touched the robot, whoever moved
  double driven = 0.0;         ///< way of the robot [m]
  double wanted = 0.0;         ///< way without anybody [m]
  double stopped = 0.0;        ///< time at a stand [s]
  double duration = 0.0;       ///< [s]
};

inline constexpr double kTick = 0.01;      // [s]
inline constexpr int kTicksPerCycle = 5;   // commands
inline constexpr int kTicksPerSight = 10;  // of the agents
inline constexpr int kTicksLate = 10;
inline constexpr int kTicks = 1500;
inline constexpr double kSightError = 0.05;  // [m]

// What the robot's driver wants: now and then another curve.
class Driver {
 public:
  Driver(const Vehicle& vehicle, double speed, RandomStream& random)
      : vehicle_(vehicle), random_(random) {
    const bool reverse = random.uniform() < 0.25;
    speed_ = reverse ? -speed : speed;
  }
  Command command(double time) {
    if (time >= next_) {
      next_ = time + random_.uniform(0.5, 3.0);
      const double most = 1.0 / vehicle_.turning_radius();
      curvature_ = random_.uniform() < 0.4 ? 0.0 : random_.uniform(-most, most);
    }
    return {speed_, std::atan(vehicle_.wheelbase_m * curvature_), speed_ * curvature_};
  }
  double speed() const { return speed_; }

 private:
  const Vehicle& vehicle_;
  RandomStream& random_;
  double speed_;
  double curvature_ = 0.0;
  double next_ = 0.0;
};

// Someone, and what he is up to.
class Actor {
 public:
  Actor(Behavior behavior, const Vehicle& vehicle, double robot_speed, RandomStream& random)
      : behavior_(behavior), outline_(vehicle.footprint), random_(random) {
    ahead_ = robot_speed < 0.0 ? -1.0 : 1.0;
    lead_ = ahead_ > 0.0 ? outline_.front_m : outline_.rear_m;
    agent_.radius_m = random.uniform(0.25, 0.4);
    speed_ = random.uniform(0.4, 1.6);
    side_ = random.uniform() < 0.5 ? -1.0 : 1.0;
    when_ = random.uniform(0.5, 8.0);
    const auto place = [&](double along, double aside) {
      agent_.position = Point2(ahead_ * (lead_ + along), side_ * aside);
    };
    switch (behavior) {
      case Behavior::kStands:
        place(random.uniform(1.0, 15.0), random.uniform(0.0, 3.0));
        break;
      case Behavior::kStraight: {
        place(random.uniform(-10.0, 12.0), random.uniform(2.5, 10.0));
        const double course = random.uniform(-kPi, kPi);
        course_ = Point2(std::cos(course), std::sin(course));
        break;
      }
      case Behavior::kCrosses:
      case Behavior::kCrossesStops:
      case Behavior::kErratic:
        place(random.uniform(2.0, 10.0), random.uniform(2.0, 8.0));
        break;
      case Behavior::kTurnsTowards:
        place(random.uniform(-1.0, 6.0), random.uniform(1.6, 4.0));
        break;
      case Behavior::kRunsAtRobot:
        place(random.uniform(-8.0, 12.0), random.uniform(2.5, 8.0));
        speed_ = 1.6;
        break;
      case Behavior::kFromBehind:
        place(random.uniform(-12.0, -6.0), random.uniform(0.0, 3.0));
        speed_ = 1.6;
        break;
    }
  }

  const Agent& agent() const { return agent_; }

  void move(const VehicleState& robot, double time, double acceleration) {
    Point2 wanted = velocity(robot, time);
    if (acceleration > 0.0) {
      const Point2 change = wanted - agent_.velocity;
      const double most = acceleration * kTick;
      if (change.norm() > most) wanted = agent_.velocity + most / change.norm() * change;
    }
    agent_.velocity = wanted;
    agent_.position += kTick * wanted;
  }

  // The robot is solid: who walks into it stands at its edge.
  void pushed_out(const Pose2& T_map_base) {
    const Point2 p = inverse(T_map_base) * agent_.position;
    const double gap = outline_distance(outline_, p) - agent_.radius_m;
    if (gap >= 0.0 || gap <= -agent_.radius_m) return;
    const double half = 0.5 * outline_.width_m;
    const Point2 edge(std::clamp(p.x(), -outline_.rear_m, outline_.front_m),
                      std::clamp(p.y(), -half, half));
    agent_.position = T_map_base * Point2(edge + (p - edge).normalized() * agent_.radius_m);
  }

 private:
  // Towards a place in the robot's frame, `speed_` fast; a little ahead of where the robot goes.
  Point2 towards(const VehicleState& robot, double along, double aside) const {
    const Point2 way =
        robot.pose * Point2(ahead_ * (lead_ + along), side_ * aside) - agent_.position;
    return way.norm() > 0.05 ? Point2(speed_ / way.norm() * way) : Point2(0.0, 0.0);
  }

  Point2 velocity(const VehicleState& robot, double time) {
    const Point2 heading = ahead_ * robot.pose.heading();
    switch (behavior_) {
      case Behavior::kStands:
        return {0.0, 0.0};
      case Behavior::kStraight:
        return speed_ * course_;
      case Behavior::kCrosses:
      case Behavior::kCrossesStops: {
        // Aims at the middle of the way once; then walks straight.
        if (course_.isZero()) {
          course_ = towards(robot, random_.uniform(0.5, 3.0), 0.0).normalized();
        }
        const double aside = (inverse(robot.pose) * agent_.position).y();
        if (behavior_ == Behavior::kCrossesStops && std::abs(aside) < 0.5) return {0.0, 0.0};
        return speed_ * course_;
      }
      case Behavior::kTurnsTowards:
        return time < when_ ? Point2(std::min(speed_, std::abs(robot.speed) + 0.1) * heading)
                            : towards(robot, 0.4, 0.0);
      case Behavior::kRunsAtRobot:
        return towards(robot, -0.3, 0.0);
      case Behavior::kFromBehind: {
        const Point2 p = inverse(robot.pose) * agent_.position;
        const bool past = ahead_ * p.x() > lead_ + 0.2;
        return past ? towards(robot, 0.3, 0.0)
                    : towards(robot, 1.5, 0.5 * outline_.width_m + agent_.radius_m + 0.15);
      }
      case Behavior::kErratic:
        if (time >= next_) {
          next_ = time + 0.5;
          const double course = random_.uniform(-kPi, kPi);
          erratic_ = random_.uniform(0.0, 1.6) * Point2(std::cos(course), std::sin(course));
          if (random_.uniform() < 0.5) erratic_ = towards(robot, 0.5, 0.0);
        }
        return erratic_;
    }
    return {0.0, 0.0};
  }

  Behavior behavior_;
  Footprint outline_;
  RandomStream& random_;
  Agent agent_;
  double ahead_ = 1.0;  // 1: the robot drives forwards
  double lead_ = 0.0;   // from base to the leading edge [m]
  double speed_ = 1.0;
  double side_ = 1.0;
  double when_ = 0.0;
  double next_ = 0.0;
  Point2 course_{0.0, 0.0};
  Point2 erratic_{0.0, 0.0};
};

// How fast the outline moves towards someone it touches [m/s]; 0 if it does not touch him.
inline double closing(const Vehicle& vehicle, const VehicleState& robot, const Agent& agent,
                      bool& touched) {
  const Footprint& outline = vehicle.footprint;
  const Point2 p = inverse(robot.pose) * agent.position;
  if (outline_distance(outline, p) > agent.radius_m) return 0.0;
  touched = true;
  return outline_closing(vehicle, robot, agent.position);
}

/// Fifteen seconds of a vehicle that drives as random commands say (turning, forwards or backwards,
/// up to `speed` [m/s]), with the fail-safe beneath, and of one or two agents up to 1.6 m/s. Agents
/// turn at once, or with `agent_acceleration` [m/s2] if that is positive. The robot sees them ten
/// times a second, 0.1 s late, with an error of 5 cm; how old a sight is it knows only where it
/// goes by observed velocities. Its actuators have their lags and dead times. The truth moves in
/// steps of 10 ms.
inline Encounter encounter(const Vehicle& vehicle, const FailSafeConfig& config, Behavior behavior,
                           double speed, double agent_acceleration, RandomStream& random) {
  FailSafe fail_safe(vehicle, config);
  Driver driver(vehicle, speed, random);
  std::vector<Actor> actors;
  const int count = 1 + random.index(2);
  for (int i = 0; i < count; ++i) actors.emplace_back(behavior, vehicle, driver.speed(), random);
  CommandDelay delay(vehicle, kTick * kTicksPerCycle);
  VehicleState robot;
  std::deque<std::vector<Agent>> sights;
  Command acting;
  Encounter result;
  std::vector<Agent> seen;
  double seen_at = 0.0;
  for (int tick = 0; tick < kTicks; ++tick) {
    const double time = kTick * tick;
    std::vector<Agent> truth;
    for (const Actor& actor : actors) truth.push_back(actor.agent());
    sights.push_back(truth);
    if (static_cast<int>(sights.size()) > kTicksLate + 1) sights.pop_front();
    if (tick % kTicksPerSight == 0) {
      seen = sights.front();
      seen_at = kTick * std::max(0, tick - kTicksLate);
      for (Agent& agent : seen) {
        agent.position += kSightError * Point2(random.normal(), random.normal());
        agent.noise_m = kSightError;
      }
    }
    if (tick % kTicksPerCycle == 0) {
      const double age = config.agents == AgentMotion::kObserved ? time - seen_at : 0.0;
      const LocalScene scene{time, robot, seen, nullptr, age};
      acting = delay.push(fail_safe.limit(scene, driver.command(time)).command);
    }
    robot = step_vehicle(vehicle, robot, acting, kTick);
    for (Actor& actor : actors) {
      actor.move(robot, time, agent_acceleration);
      result.worst_closing =
          std::max(result.worst_closing, closing(vehicle, robot, actor.agent(), result.touched));
      actor.pushed_out(robot.pose);
    }
    result.driven += std::abs(robot.speed) * kTick;
    if (std::abs(robot.speed) < 0.05) result.stopped += kTick;
  }
  result.duration = kTick * kTicks;
  result.wanted = speed * (result.duration - 0.5 * speed / vehicle.acceleration_mps2);
  return result;
}

}  // namespace headland::test
