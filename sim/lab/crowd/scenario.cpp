// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/crowd/scenario.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

using namespace crowd_protocol;

constexpr double kApart = 2.0 * kRadius + kNear;  // of centres

double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

class Generator {
 public:
  Generator(std::uint64_t seed, int run) : random_(seed, fmt::format("crowd scenario {}", run)) {}

  CrowdScenario scenario() {
    const int people = kLeastPeople + random_.index(kMostPeople - kLeastPeople + 1);
    const Point2 start = on_circle();
    walks_.push_back({start, -start});
    for (int i = 0; i < people; ++i) {
      walks_.push_back(random_.uniform() < kCircleShare ? crosses_circle() : crosses_square());
    }
    return {walks_.front(), {walks_.begin() + 1, walks_.end()}};
  }

 private:
  Point2 on_circle() {
    const double angle = random_.uniform(0.0, 2.0 * std::numbers::pi);
    return kCircleRadius * Point2(std::cos(angle), std::sin(angle));
  }

  bool is_free(const Point2& p, Point2 CrowdWalk::*end) const {
    for (const CrowdWalk& walk : walks_) {
      if ((p - walk.*end).norm() < kApart) return false;
    }
    return true;
  }

  CrowdWalk crosses_circle() {
    Point2 start;
    do {
      const Point2 noise(random_.uniform(-0.5, 0.5), random_.uniform(-0.5, 0.5));
      start = on_circle() + kSpeed * noise;
    } while (!is_free(start, &CrowdWalk::start) || !is_free(start, &CrowdWalk::goal));
    return {start, off_the_robots_goal(-start)};
  }

  // From one half of the square to the other.
  CrowdWalk crosses_square() {
    const double side = random_.uniform() > 0.5 ? -1.0 : 1.0;
    CrowdWalk walk;
    do {
      walk.start = in_half(side);
    } while (!is_free(walk.start, &CrowdWalk::start));
    do {
      walk.goal = in_half(-side);
    } while (!is_free(walk.goal, &CrowdWalk::goal));
    walk.goal = off_the_robots_goal(walk.goal);
    return walk;
  }

  Point2 in_half(double side) {
    const double x = side * random_.uniform(0.0, kSquareWidth / 2.0);
    return {x, random_.uniform(-kSquareWidth / 2.0, kSquareWidth / 2.0)};
  }

  // Nobody shall stand there. As published, y too is pushed away from the goal's x.
  Point2 off_the_robots_goal(const Point2& goal) const {
    constexpr double kTooNear = 1.5;
    constexpr double kPush = 2.0;
    const Point2& robot = walks_.front().goal;
    const Point2 off = goal - robot;
    if (std::abs(off.x()) >= kTooNear || std::abs(off.y()) >= kTooNear) return goal;
    return goal + kPush * Point2(sign(off.x()), sign(goal.y() - robot.x()));
  }

  RandomStream random_;
  std::vector<CrowdWalk> walks_;  // the robot's first
};

}  // namespace

CrowdScenario crowd_scenario(std::uint64_t seed, int run) {
  return Generator(seed, run).scenario();
}

}  // namespace headland
