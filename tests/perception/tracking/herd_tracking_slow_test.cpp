// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "perception/tracking/agent_tracker.hpp"
#include "perception/tracking/metrics.hpp"
#include "tests/support/herd_scene.hpp"

namespace headland {
namespace {

// Those count of whom the lidar sees at least 30 % of the width, within `range`.
AgentTrackingScore follow_herd(double area_per_agent_m2, double range, unsigned seed) {
  testing::HerdScene scene({.area_per_agent_m2 = area_per_agent_m2}, seed);
  AgentTracker tracker;
  AgentTrackingMetrics metrics(0.5);
  std::vector<Agent> agents;
  std::vector<TrackPoint> told;
  for (int k = 0; k < 300; ++k) {
    scene.step(0.1);
    scene.scan();
    tracker.update(scene.detections(), scene.view(), scene.time_s());
    EXPECT_TRUE(tracker.agents_at(scene.time_s(), agents));
    told.clear();
    for (const Agent& agent : agents) {
      if (agent.position.norm() <= range)
        told.push_back({agent.id, agent.position, agent.velocity});
    }
    if (k >= 10) metrics.add(scene.truth(range, 0.3), told);
  }
  return metrics.score();
}

TEST(HerdTracking, FollowsASparseHerd) {
  for (const unsigned seed : {11u, 12u}) {
    const AgentTrackingScore score = follow_herd(50.0, 15.0, seed);
    EXPECT_GE(score.mota, 0.95);
    EXPECT_GE(score.idf1, 0.85);
    EXPECT_LE(score.position_rmse_m, 0.10);
  }
}

TEST(HerdTracking, FollowsADenseHerd) {
  for (const unsigned seed : {11u, 12u}) {
    const AgentTrackingScore score = follow_herd(10.0, 10.0, seed);
    EXPECT_GE(score.mota, 0.80);
    EXPECT_LE(score.position_rmse_m, 0.15);
  }
}

}  // namespace
}  // namespace headland
