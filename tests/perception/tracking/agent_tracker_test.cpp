// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/agent_tracker.hpp"

#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/herd_scene.hpp"

namespace headland {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kStep = 0.1;

Detection seen_at(const Point2& position, int points = 20) {
  Detection detection;
  detection.position = position;
  detection.points_count = points;
  return detection;
}

using Detections = std::vector<Detection>;

std::vector<Agent> agents_of(const AgentTracker& tracker, double time_s) {
  std::vector<Agent> agents;
  EXPECT_TRUE(tracker.agents_at(time_s, agents));
  return agents;
}

// Somebody who stands at (10, 0), confirmed at time 0.3 s.
AgentTracker with_one() {
  AgentTracker tracker;
  for (int k = 0; k <= 3; ++k) tracker.update(Detections{seen_at({10.0, 0.0})}, {}, k * kStep);
  return tracker;
}

// Scans without anybody until the last track is gone [s].
double lives_on(AgentTracker& tracker, const SensorView& view) {
  double time = 0.3;
  while (!tracker.tracks().empty() && time < 20.0) tracker.update({}, view, time += kStep);
  return time - 0.3;
}

TEST(AgentTracker, FollowsAWalkerWithOneId) {
  RandomStream random(1, "agent_tracker");
  AgentTracker tracker;
  std::set<int> ids;
  double square_sum = 0.0;
  double velocity_square_sum = 0.0;
  for (int k = 0; k < 100; ++k) {
    const Point2 truth(-5.0 + 1.2 * kStep * k, 6.0);
    const Point2 noise(0.1 * random.normal(), 0.1 * random.normal());
    EXPECT_EQ(tracker.update(Detections{seen_at(truth + noise)}, {}, k * kStep),
              AgentTrackerStatus::kUpdated);
    for (const Agent& agent : agents_of(tracker, k * kStep)) {
      ids.insert(agent.id);
      if (k < 30) continue;
      square_sum += (agent.position - truth).squaredNorm();
      velocity_square_sum += (agent.velocity - Point2(1.2, 0.0)).squaredNorm();
    }
  }
  EXPECT_EQ(ids.size(), 1u);
  EXPECT_LT(std::sqrt(square_sum / 70.0), 0.11);  // unfiltered: 0.14
  EXPECT_LT(std::sqrt(velocity_square_sum / 70.0), 0.6);
}

TEST(AgentTracker, ConfirmsWhoIsSeenInTwoOfThreeScans) {
  AgentTracker tracker;
  tracker.update(Detections{seen_at({10.0, 0.0})}, {}, 0.0);
  EXPECT_TRUE(agents_of(tracker, 0.0).empty());
  tracker.update({}, {}, 0.1);
  tracker.update(Detections{seen_at({10.0, 0.0})}, {}, 0.2);
  EXPECT_EQ(agents_of(tracker, 0.2).size(), 1u);
}

TEST(AgentTracker, ForgetsWhoIsSeenInOneOfThreeScans) {
  AgentTracker tracker;
  tracker.update(Detections{seen_at({10.0, 0.0})}, {}, 0.0);
  tracker.update({}, {}, 0.1);
  tracker.update({}, {}, 0.2);
  EXPECT_TRUE(tracker.tracks().empty());
}

TEST(AgentTracker, WhoOughtToBeSeenAndIsNotDiesSoon) {
  AgentTracker tracker = with_one();
  EXPECT_LE(lives_on(tracker, {}), 0.7);
}

TEST(AgentTracker, WhoIsHiddenLivesLonger) {
  SensorView occluded;
  occluded.hidden.push_back({-0.3, 0.6, 5.0});
  SensorView blind;
  blind.hidden.push_back({-0.3, 0.6, 0.0});
  SensorView near_only;
  near_only.far_m = 8.0;
  for (const SensorView& view : {occluded, blind, near_only}) {
    AgentTracker tracker = with_one();
    const double life = lives_on(tracker, view);
    EXPECT_GT(life, 0.9);
    EXPECT_LT(life, 5.0);
  }
}

TEST(AgentTracker, SomebodyInFrontHides) {
  AgentTracker tracker = with_one();
  double time = 0.3;
  for (int k = 0; k < 9; ++k) {
    tracker.update(Detections{seen_at({5.0, 0.0})}, {}, time += kStep);
  }
  EXPECT_EQ(agents_of(tracker, time).size(), 2u);
  const int id = tracker.tracks()[0].id;
  tracker.update(Detections{seen_at({5.0, 0.0}), seen_at({10.0, 0.1})}, {}, time += kStep);
  EXPECT_EQ(tracker.tracks()[0].id, id);
  EXPECT_EQ(tracker.tracks()[0].absence, 0.0);
}

TEST(AgentTracker, WeakClustersContinueTracksAndBeginNone) {
  AgentTracker tracker = with_one();
  double time = 0.3;
  for (int k = 0; k < 20; ++k) {
    tracker.update(Detections{seen_at({10.0, 0.0}, 2), seen_at({0.0, 10.0}, 2)}, {}, time += kStep);
  }
  ASSERT_EQ(tracker.tracks().size(), 1u);
  EXPECT_LT((tracker.tracks()[0].position() - Point2(10.0, 0.0)).norm(), 0.1);
}

TEST(AgentTracker, TwoWhoMergeAreStillTwo) {
  // They walk side by side, come as near as 0.5 m and part again; the lidar sees one cluster.
  AgentTracker tracker;
  std::set<int> ids;
  double worst = 0.0;
  for (int k = 0; k < 80; ++k) {
    const double apart = std::max(0.5, 2.0 - 0.05 * std::min(k, 80 - k));
    const Point2 a(8.0 + 0.03 * k, 0.5 * apart);
    const Point2 b(8.0 + 0.03 * k, -0.5 * apart);
    std::vector<Point2> points_a;
    std::vector<Point2> points_b;
    for (int i = -8; i <= 8; ++i) {
      const double aside = 0.2 * i / 8.5;
      const double depth = std::sqrt(0.04 - aside * aside);
      points_a.push_back(a + Point2(-depth, aside));
      points_b.push_back(b + Point2(-depth, aside));
    }
    Detections detections;
    if (apart < 0.9) points_a.insert(points_a.end(), points_b.begin(), points_b.end());
    detections.push_back(*detect_body(points_a, {0.0, 0.0}, {}));
    if (apart >= 0.9) detections.push_back(*detect_body(points_b, {0.0, 0.0}, {}));
    tracker.update(detections, {}, k * kStep);
    if (k < 5) continue;
    const std::vector<Agent> agents = agents_of(tracker, k * kStep);
    ASSERT_EQ(agents.size(), 2u);
    for (const Agent& agent : agents) {
      ids.insert(agent.id);
      worst = std::max(worst, std::min((agent.position - a).norm(), (agent.position - b).norm()));
    }
  }
  EXPECT_EQ(ids.size(), 2u);
  EXPECT_LT(worst, 0.2);
}

TEST(AgentTracker, AClusterAsLongAsTwoPeopleIsTwoPeople) {
  std::vector<Point2> points;
  for (int i = -15; i <= 15; ++i) {
    if (std::abs(i) > 2) points.emplace_back(8.0, 0.05 * i);
  }
  Detection pair = *detect_body(points, {0.0, 0.0}, {});
  pair.probability = {0.8, 0.1, 0.05, 0.05};
  AgentTracker tracker;
  for (int k = 0; k < 10; ++k) tracker.update(Detections{pair}, {}, k * kStep);
  EXPECT_EQ(agents_of(tracker, 0.9).size(), 2u);
  // ... and as long as one cow it is one cow.
  pair.probability = {0.1, 0.8, 0.05, 0.05};
  AgentTracker other;
  for (int k = 0; k < 10; ++k) other.update(Detections{pair}, {}, k * kStep);
  EXPECT_EQ(agents_of(other, 0.9).size(), 1u);
}

TEST(AgentTracker, SeveralDetectionsOfOneBodyAreOneAgent) {
  AgentTracker tracker;
  for (int k = 0; k < 30; ++k) {
    const Detection body = seen_at({10.0, 0.02 * k});
    tracker.update(Detections{body, body, body}, {}, k * kStep);
  }
  EXPECT_EQ(agents_of(tracker, 2.9).size(), 1u);
}

TEST(AgentTracker, LeavesUnsoundDetectionsOut) {
  AgentTracker tracker;
  for (int k = 0; k < 10; ++k) {
    Detection singular = seen_at({5.0, 5.0});
    singular.covariance.setZero();
    tracker.update(Detections{seen_at({kNan, 0.0}), seen_at({1e12, 0.0}), singular,
                              seen_at({4.0, 4.0}, 0), seen_at({10.0, 0.0})},
                   {}, k * kStep);
  }
  ASSERT_EQ(tracker.tracks().size(), 1u);
  EXPECT_TRUE(tracker.tracks()[0].state.allFinite());
}

TEST(AgentTracker, AnUnknownViewHidesAllAndInventsNothing) {
  AgentTracker tracker = with_one();
  SensorView view;
  view.sensor = {kNan, kNan};
  EXPECT_LT(lives_on(tracker, view), 5.0);
  EXPECT_TRUE(tracker.tracks().empty());
}

TEST(AgentTracker, IgnoresScansThatAreLateOrTwice) {
  AgentTracker tracker = with_one();
  const Eigen::Vector4d before = tracker.tracks()[0].state;
  for (const double time : {0.3, 0.25, kNan, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(tracker.update(Detections{seen_at({10.5, 0.0})}, {}, time),
              AgentTrackerStatus::kBadTime);
  }
  EXPECT_EQ(tracker.tracks()[0].state, before);
}

TEST(AgentTracker, RestartsWhenTimeWasSetBackOrJumpsAhead) {
  for (const double time : {-100.0, 60.0}) {
    AgentTracker tracker = with_one();
    const int before = tracker.tracks()[0].id;
    EXPECT_EQ(tracker.update(Detections{seen_at({10.0, 0.0})}, {}, time),
              AgentTrackerStatus::kRestarted);
    ASSERT_EQ(tracker.tracks().size(), 1u);
    EXPECT_NE(tracker.tracks()[0].id, before);
    EXPECT_FALSE(tracker.tracks()[0].confirmed);
  }
}

TEST(AgentTracker, GivesNobodyWithoutAScanOrFromAStaleOne) {
  std::vector<Agent> agents(3);
  EXPECT_FALSE(AgentTracker().agents_at(0.0, agents));
  EXPECT_TRUE(agents.empty());
  const AgentTracker tracker = with_one();
  EXPECT_TRUE(tracker.agents_at(0.8, agents));
  EXPECT_EQ(agents.size(), 1u);
  for (const double time : {5.0, 0.0, kNan}) {
    EXPECT_FALSE(tracker.agents_at(time, agents));
    EXPECT_TRUE(agents.empty());
  }
}

TEST(AgentTracker, MovesAgentsOnToTheTimeAskedFor) {
  AgentTracker tracker;
  for (int k = 0; k < 50; ++k) {
    tracker.update(Detections{seen_at({5.0 + 0.1 * k, 5.0})}, {}, k * kStep);
  }
  const Agent now = agents_of(tracker, 4.9).at(0);
  const Agent later = agents_of(tracker, 5.4).at(0);
  EXPECT_NEAR((later.position - now.position).norm(), 0.5 * now.velocity.norm(), 1e-9);
  EXPECT_GT(later.noise_m, now.noise_m);
}

TEST(AgentTracker, SaysWhichClusterIsWhose) {
  AgentTracker tracker;
  Detection body = seen_at({10.0, 0.0});
  for (int k = 0; k < 3; ++k) {
    body.cluster = 40 + k;
    tracker.update(Detections{body}, {}, k * kStep);
    EXPECT_EQ(tracker.tracks()[0].cluster, 40 + k);
  }
  tracker.update({}, {}, 0.3);
  EXPECT_EQ(tracker.tracks()[0].cluster, -1);
}

TEST(AgentTracker, IsDeterministic) {
  testing::HerdScene scene({.half_side_m = 8.0}, 5);
  AgentTracker a;
  AgentTracker b;
  for (int k = 0; k < 60; ++k) {
    scene.step(kStep);
    scene.scan();
    a.update(scene.detections(), scene.view(), scene.time_s());
    b.update(scene.detections(), scene.view(), scene.time_s());
    ASSERT_EQ(a.tracks().size(), b.tracks().size());
    for (std::size_t t = 0; t < a.tracks().size(); ++t) {
      EXPECT_EQ(a.tracks()[t].id, b.tracks()[t].id);
      EXPECT_EQ(a.tracks()[t].state, b.tracks()[t].state);
    }
  }
}

TEST(AgentTracker, DoesNotAllocateOnceItHasHeldAsMany) {
  // Fifty who stand in the field, the first two of them in one cluster.
  std::vector<Point2> merged;
  for (int i = -15; i <= 15; ++i) merged.emplace_back(8.0, 0.05 * i);
  Detections crowd = {*detect_body(merged, {0.0, 0.0}, {})};
  crowd[0].probability = {0.8, 0.1, 0.05, 0.05};
  for (int i = 0; i < 48; ++i) {
    crowd.push_back(seen_at(12.0 * Point2(std::cos(0.3 + 0.12 * i), std::sin(0.3 + 0.12 * i))));
  }
  AgentTracker tracker;
  long before = 0;
  for (int k = 0; k < 40; ++k) {
    if (k == 10) before = testing::allocation_count();
    tracker.update(crowd, {}, k * kStep);
  }
  EXPECT_EQ(testing::allocation_count(), before);
  EXPECT_EQ(tracker.tracks().size(), 50u);
}

}  // namespace
}  // namespace headland
