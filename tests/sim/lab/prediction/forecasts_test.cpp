// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/prediction/forecasts.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

Track walker(int id, AgentKind kind, int first, int last, double step) {
  Track track{id, kind, {}, {}};
  for (int k = first; k <= last; ++k) {
    track.time_s.push_back(step * k);
    track.position.emplace_back(step * k, id);
  }
  return track;
}

PredictorFactory constant_velocity() {
  return *predictor_factory(PredictorKind::kConstantVelocity);
}

TEST(SampledTracks, KnowsWhoWasRecordedAtASampleAndInventsNothing) {
  TrackSet set{"", 0.5, {walker(1, AgentKind::kPerson, 0, 9, 0.5)}};
  Track& track = set.tracks.front();
  track.time_s.erase(track.time_s.begin() + 4);
  track.position.erase(track.position.begin() + 4);
  const SampledTracks sampled(set, 0.1);
  EXPECT_EQ(sampled.samples(), 10);
  EXPECT_TRUE(sampled.position(0, 3));
  EXPECT_FALSE(sampled.position(0, 4)) << "a gap";
  EXPECT_FALSE(sampled.position(0, 10));
  std::vector<Agent> agents;
  sampled.see(3, agents);
  ASSERT_EQ(agents.size(), 1U);
  EXPECT_EQ(agents[0].velocity, Point2(0.0, 0.0)) << "predictors find velocities themselves";
  EXPECT_EQ(agents[0].noise_m, 0.1);
  sampled.see(4, agents);
  EXPECT_TRUE(agents.empty());
}

TEST(Forecasts, CountAgentsOfTheKindThatWereRecordedAtAllSteps) {
  const TrackSet set{"",
                     0.4,
                     {walker(1, AgentKind::kPerson, 0, 9, 0.4),
                      walker(2, AgentKind::kPerson, 3, 9, 0.4),  // too late for the first
                      walker(3, AgentKind::kDog, 0, 9, 0.4)}};
  const ForecastShape shape{0.4, 4, 3, AgentKind::kPerson};
  const auto found = forecast(SampledTracks(set), shape, constant_velocity());
  ASSERT_EQ(found.size(), 5U);  // of 1 at samples 3, 4, 5, 6; of 2 at 6
  EXPECT_EQ(found[3].track, 0);
  EXPECT_EQ(found[4].track, 1);
  for (const Forecast& one : found) {
    ASSERT_EQ(one.error_m.size(), 3U);
    EXPECT_LT(one.error_m.back(), 0.1);
    EXPECT_EQ(one.covered_ratio, 1.0);
  }
}

TEST(Forecasts, ShowAllSamplesBetweenTheSteps) {
  // Steps of 0.4 s of a recording at 0.1 s: velocities are known better than from 4 sights.
  const TrackSet set{"", 0.1, {walker(1, AgentKind::kSheep, 0, 40, 0.1)}};
  const ForecastShape shape{0.4, 4, 3, AgentKind::kSheep};
  const auto found = forecast(SampledTracks(set), shape, constant_velocity());
  ASSERT_EQ(found.size(), 5U);
  EXPECT_LT(found.front().error_m.back(), 0.02);
}

}  // namespace
}  // namespace headland
