// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/random.hpp"
#include "core/world/agent.hpp"
#include "sim/crowd/crowd.hpp"

namespace headland {

/// A robot that drives about in a crowd in the ways a robot might, so that a predictor can learn
/// what agents do about each: straight, to places, around people, towards them, standing, backing.
/// It changes its way every few seconds. Speed, acceleration and curvature are limited.
/// Deterministic for a seed.
class WanderingRobot {
 public:
  /// Drives around the origin, within `reach` [m]; agents take it to have `radius` [m].
  WanderingRobot(double reach, double radius, std::uint64_t seed);

  void step(double dt, std::span<const Agent> agents);
  CrowdRobot body() const { return {position_, velocity(), radius_m_, 0.5}; }
  const Point2& position() const { return position_; }
  Point2 velocity() const;

 private:
  enum class Way : std::int8_t { kStraight, kPlace, kAround, kTowards, kStanding, kBacking };
  void choose_way();
  Point2 wanted_velocity(std::span<const Agent> agents) const;

  RandomStream random_;
  double reach_m_;
  double radius_m_;
  double top_speed_ = 1.0;     // of this robot [m/s]
  double acceleration_ = 0.8;  // [m/s2]
  double curvature_ = 0.5;     // largest [1/m]
  Way way_ = Way::kStraight;
  double left_s_ = 0.0;  // until it changes its way
  double wish_ = 1.0;    // speed on this way [m/s]
  Point2 place_{0.0, 0.0};
  Point2 position_{0.0, 0.0};
  double yaw_ = 0.0;
  double speed_ = 0.0;
};

}  // namespace headland
