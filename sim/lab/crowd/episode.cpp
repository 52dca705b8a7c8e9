// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/crowd/episode.hpp"

#include <algorithm>
#include <limits>

#include "sim/crowd/crowd.hpp"

namespace headland {
namespace {

using namespace crowd_protocol;

constexpr int kSubsteps = 5;      // of the robot, in a step of the people
constexpr double kStands = 0.05;  // slower towards a person, the robot does not collide: it is hit

Crowd crowd_of(const CrowdScenario& scenario) {
  CrowdConfig config;
  config.horizon_s = kOrcaHorizon;
  config.neighbor_distance_m = kNeighborDistance;
  config.max_neighbor_count = kMostNeighbors;
  config.nudge_mps = 0.0;
  std::vector<CrowdAgent> people;
  for (const CrowdWalk& walk : scenario.people) {
    CrowdAgent person;
    person.position = walk.start;
    person.goal = walk.goal;
    person.radius_m = kRadius + kOrcaMargin;
    person.speed_mps = kSpeed;
    person.max_speed_mps = kSpeed;
    people.push_back(person);
  }
  return {config, std::move(people)};
}

// From the origin to the nearest point of a segment.
double distance_to_segment(const Point2& a, const Point2& b) {
  const Point2 along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp(-a.dot(along) / length2, 0.0, 1.0) : 0.0;
  return (a + t * along).norm();
}

class Drive {
 public:
  Drive(const CrowdScenario& scenario, EpisodeRobot& robot)
      : robot_(robot), crowd_(crowd_of(scenario)) {
    outcome_.people_count = static_cast<double>(scenario.people.size());
    outcome_.gap_m = std::numeric_limits<double>::max();
    look();
    before_ = seen_;
  }

  const std::vector<Agent>& seen() const { return seen_; }
  const CrowdOutcome& outcome() const { return outcome_; }
  double time() const { return time_; }

  // People at their true size.
  void look() {
    seen_.assign(crowd_.agents().begin(), crowd_.agents().end());
    for (Agent& person : seen_) person.radius_m = kRadius;
  }

  // Of the people near the robot, from the step before to now; the first step, from a stand, is
  // none's disturbance.
  void count_disturbances() {
    if (time_ < 1.5 * kStep) return;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if ((seen_[i].position - robot_.position()).norm() >= kDisturbanceReach) continue;
      const double change = (seen_[i].velocity - before_[i].velocity).norm() / kStep;
      outcome_.seen_count += 1.0;
      outcome_.disturbed_count += change > kDisturbance ? 1.0 : 0.0;
      outcome_.disturbed_half_count += change > kDisturbance / 2.0 ? 1.0 : 0.0;
      outcome_.disturbed_quarter_count += change > kDisturbance / 4.0 ? 1.0 : 0.0;
    }
  }

  // All move at once; returns the least distance of outlines on the way.
  double move(bool visible) {
    const std::vector<CrowdRobot> robots = {
        {robot_.position(), robot_.velocity(), kRadius + kOrcaMargin}};
    crowd_.step(kStep, visible ? std::span<const CrowdRobot>(robots) : std::span<CrowdRobot>());
    before_ = seen_;
    look();
    double gap = std::numeric_limits<double>::max();
    for (int k = 0; k < kSubsteps; ++k) gap = std::min(gap, move_robot(k));
    time_ += kStep;
    outcome_.time_s = time_;
    outcome_.gap_m = std::min(outcome_.gap_m, gap);
    return gap;
  }

  void end(bool success, bool collision) {
    outcome_.success_count = success ? 1.0 : 0.0;
    outcome_.collision_count = collision ? 1.0 : 0.0;
  }
  void count_near_miss() { outcome_.near_count += 1.0; }

 private:
  double move_robot(int substep) {
    constexpr double kDt = kStep / kSubsteps;
    const Point2 from = robot_.position();
    robot_.move(time_ + kDt * substep, kDt);
    const Point2 to = robot_.position();
    outcome_.length_m += (to - from).norm();
    double gap = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const auto person = [&](int at) -> Point2 {
        const double ratio = static_cast<double>(at) / kSubsteps;
        return before_[i].position + ratio * (seen_[i].position - before_[i].position);
      };
      const double distance = distance_to_segment(person(substep) - from, person(substep + 1) - to);
      gap = std::min(gap, distance - 2.0 * kRadius);
      const Point2 towards = (person(substep) - from).normalized();
      if (distance < 2.0 * kRadius && (to - from).dot(towards) > kStands * kDt) {
        outcome_.fault_count = 1.0;
      }
    }
    return gap;
  }

  EpisodeRobot& robot_;
  Crowd crowd_;
  std::vector<Agent> seen_;
  std::vector<Agent> before_;  // a step ago
  CrowdOutcome outcome_;
  double time_ = 0.0;
};

}  // namespace

CrowdOutcome run_crowd_episode(const CrowdScenario& scenario, bool visible, EpisodeRobot& robot,
                               const Clock& clock, std::vector<double>& plan_ms) {
  Drive drive(scenario, robot);
  while (drive.time() < kTimeout) {
    drive.count_disturbances();
    const double begin = clock.now();
    robot.decide(drive.time(), drive.seen());
    plan_ms.push_back(1e3 * (clock.now() - begin));
    const double gap = drive.move(visible);
    const bool collision = gap < 0.0;
    const bool reached = (robot.position() - scenario.robot.goal).norm() < kGoal;
    if (collision || reached) {
      drive.end(!collision, collision);
      break;
    }
    if (gap < kNear) drive.count_near_miss();
  }
  return drive.outcome();
}

}  // namespace headland
