// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/acfr/episode.hpp"

#include <gtest/gtest.h>

#include "local_planner/mcts/mcts_planner.hpp"
#include "local_planner/prediction/orca_predictor.hpp"

namespace headland {
namespace {

Vehicle robot() {
  Vehicle vehicle;
  vehicle.wheelbase_m = 1.2;
  vehicle.max_steering_deg = 40.0;
  vehicle.steering_rate_radps = 0.8;
  vehicle.min_turning_radius_m = 2.0;
  vehicle.work_speed_mps = vehicle.transit_speed_mps = vehicle.turn_speed_mps = 1.5;
  vehicle.can_reverse = false;
  vehicle.footprint = {1.6, 0.4, 1.3};
  return vehicle;
}

AcfrTour two_places() {
  AcfrTour tour;
  tour.path.append_straight({0.0, 0.0, 0.0}, 36.0, 0);
  tour.places = {{18.0, 0.0}, {34.0, 0.0}};
  tour.place_s = {18.0, 34.0};
  tour.low = {0.0, -6.0};
  tour.high = {36.0, 6.0};
  return tour;
}

AcfrOutcome drive(const AcfrTour& tour, AcfrWorldConfig world, int iterations = 150,
                  double density = 10.0) {
  AcfrDrive episode;
  episode.tour = &tour;
  episode.world = &world;
  episode.vehicle = robot();
  episode.density_m2 = density;
  episode.budget.iterations = iterations;
  MctsPlanner planner(episode.vehicle, {}, std::make_unique<OrcaPredictor>());
  return drive_acfr(episode, planner);
}

TEST(AcfrEpisode, VisitsAllPlacesAmongACrowd) {
  const AcfrOutcome outcome = drive(two_places(), {});
  ASSERT_EQ(outcome.visits.size(), 2U);
  EXPECT_NEAR(outcome.visits[0].distance_m, 18.0, 1e-9);
  for (const AcfrVisit& visit : outcome.visits) {
    EXPECT_TRUE(visit.reached);
    EXPECT_GT(visit.time_s, 8.0);
  }
  EXPECT_GT(outcome.interactions.size(), 10U);
  EXPECT_NEAR(outcome.duration_s, outcome.visits[0].time_s + outcome.visits[1].time_s, 1e-9);
}

TEST(AcfrEpisode, IsTheSameEachTime) {
  const AcfrOutcome once = drive(two_places(), {});
  const AcfrOutcome again = drive(two_places(), {});
  ASSERT_EQ(once.interactions.size(), again.interactions.size());
  for (std::size_t i = 0; i < once.interactions.size(); ++i) {
    EXPECT_EQ(once.interactions[i].least_m, again.interactions[i].least_m);
  }
  EXPECT_EQ(once.length_m, again.length_m);
}

TEST(AcfrEpisode, GivesUpAPlaceAfterItsTimeout) {
  AcfrWorldConfig world;
  world.timeout_s = 3.0;
  const AcfrOutcome outcome = drive(two_places(), world);
  ASSERT_EQ(outcome.visits.size(), 2U);
  EXPECT_FALSE(outcome.visits[0].reached);
  EXPECT_NEAR(outcome.visits[0].time_s, 3.0, 0.11);
}

TEST(AcfrEpisode, AloneItKeepsToThePath) {
  const AcfrOutcome outcome = drive(two_places(), {}, 150, 1e6);
  EXPECT_TRUE(outcome.interactions.empty());
  for (const auto& [time, off] : outcome.displacements) EXPECT_LT(off, 0.5) << time;
  EXPECT_EQ(outcome.longest_stand_s, 0.0);
}

}  // namespace
}  // namespace headland
