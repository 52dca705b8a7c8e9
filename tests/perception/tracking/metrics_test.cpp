// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/metrics.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

TrackPoint at(int id, double x, double y = 0.0) {
  TrackPoint point;
  point.id = id;
  point.position = {x, y};
  return point;
}
using Points = std::vector<TrackPoint>;

TEST(AgentTrackingMetrics, WhoFollowsAllIsPerfect) {
  AgentTrackingMetrics metrics(1.0);
  for (int k = 0; k < 5; ++k)
    metrics.add(Points{at(1, k), at(2, k, 5)}, Points{at(8, k), at(9, k, 5)});
  const AgentTrackingScore score = metrics.score();
  EXPECT_EQ(score.mota, 1.0);
  EXPECT_EQ(score.idf1, 1.0);
  EXPECT_EQ(score.motp_m, 0.0);
  EXPECT_EQ(score.truth_count, 10);
}

TEST(AgentTrackingMetrics, MissesFalseTracksAndSwitchesCount) {
  AgentTrackingMetrics metrics(1.0);
  metrics.add(Points{at(1, 0.0)}, Points{at(7, 0.3)});
  metrics.add(Points{at(1, 0.0)}, Points{});                         // missed
  metrics.add(Points{at(1, 0.0)}, Points{at(8, 0.0)});               // another id
  metrics.add(Points{at(1, 0.0)}, Points{at(8, 0.0), at(9, 20.0)});  // and one of nobody
  const AgentTrackingScore score = metrics.score();
  EXPECT_EQ(score.miss_count, 1);
  EXPECT_EQ(score.switch_count, 1);
  EXPECT_EQ(score.false_count, 1);
  EXPECT_NEAR(score.mota, 1.0 - 3.0 / 4.0, 1e-12);
  EXPECT_NEAR(score.motp_m, 0.1, 1e-12);
  EXPECT_NEAR(score.position_rmse_m, 0.3 / std::sqrt(3.0), 1e-12);
  // The best lasting pair is 1 and 8: two moments of four there and four told.
  EXPECT_NEAR(score.idf1, 2.0 * 2.0 / (4.0 + 4.0), 1e-12);
}

TEST(AgentTrackingMetrics, AMatchStaysThoughAnotherIsNearer) {
  AgentTrackingMetrics metrics(1.0);
  metrics.add(Points{at(1, 0.0)}, Points{at(7, 0.1)});
  metrics.add(Points{at(1, 0.0)}, Points{at(7, 0.9), at(8, 0.0)});
  EXPECT_EQ(metrics.score().switch_count, 0);
  EXPECT_EQ(metrics.score().false_count, 1);
}

TEST(AgentTrackingMetrics, WhomNobodyCanSeeCountsNeitherWay) {
  AgentTrackingMetrics metrics(1.0);
  TrackPoint hidden = at(1, 0.0);
  hidden.counts = false;
  metrics.add(Points{hidden}, Points{});
  metrics.add(Points{hidden}, Points{at(7, 0.1)});
  EXPECT_EQ(metrics.score().truth_count, 0);
  EXPECT_EQ(metrics.score().miss_count, 0);
  EXPECT_EQ(metrics.score().false_count, 0);
}

TEST(AgentTrackingMetrics, NothingIsNoScore) {
  const AgentTrackingScore score = AgentTrackingMetrics(1.0).score();
  EXPECT_EQ(score.mota, 0.0);
  EXPECT_EQ(score.idf1, 0.0);
}

}  // namespace
}  // namespace headland
