// SPDX-License-Identifier: Apache-2.0
#include "apps/film_scene.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace headland::apps {
namespace {

// A robot that drives east at 1 m/s for so many steps of 0.1 s; agent 7 is there from the third
// step to the fifth and from the eighth on.
Film film_of(int steps) {
  Film film;
  film.name = "mcts/dense/1m, iteration 3";
  film.note = "a near-collision";
  film.path = {{0.0, 0.0}, {10.0, 0.0}};
  film.places = {{"waypoint 1", {10.0, 0.0}, 2.0}};
  film.outline = {1.6, 0.4, 1.3};
  for (int i = 0; i < steps; ++i) {
    FilmFrame frame;
    frame.time_s = 0.1 * i;
    frame.robot = {0.1 * i, 0.0, 0.0};
    frame.driven_m = 0.1 * i;
    frame.clearance_m = 3.0;
    if ((i >= 2 && i < 5) || i >= 7) {
      Agent agent;
      agent.id = 7;
      agent.position = {5.0, 0.5 * i};
      agent.radius_m = 0.5;
      frame.agents.push_back(agent);
    }
    film.frames.push_back(frame);
  }
  return film;
}

TEST(FilmScene, HoldsTheFramesThePlacesAndWhatHappened) {
  Film film = film_of(10);
  film.events = {{0.5, {3.0, 1.0}, "near_robot", "near-collision"}};
  const ReportEpisode episode = film_episode(film);
  EXPECT_EQ(episode.name, film.name);
  EXPECT_EQ(episode.note, "a near-collision");
  ASSERT_EQ(episode.scene.vehicles.size(), 1U);
  const ReportVehicle& robot = episode.scene.vehicles.front();
  EXPECT_EQ(robot.outline->width_m, 1.3);
  ASSERT_EQ(robot.series.t_s.size(), 10U);
  EXPECT_EQ(robot.series.x_m[9], film.frames[9].robot.x);
  EXPECT_EQ(robot.series.clearance_m[4], 3.0);
  EXPECT_TRUE(robot.series.steering_deg.empty()) << "it does not steer";
  std::vector<std::string> kinds;
  for (const ReportFeature& f : episode.scene.features) kinds.push_back(f.kind);
  EXPECT_EQ(kinds, (std::vector<std::string>{"plan", "goal", "poi", "near_robot"}));
  EXPECT_EQ(episode.scene.features.back().t_s, 0.5);
  const auto& circle = episode.scene.features[1].rings.front();
  for (const Point2& p : circle) EXPECT_NEAR((p - Point2(10.0, 0.0)).norm(), 2.0, 1e-12);
}

TEST(FilmScene, AgentsHaveATrackForEachTimeTheyAreSeen) {
  const ReportAgents agents = film_episode(film_of(10)).scene.agents;
  EXPECT_NEAR(agents.period_s, 0.1, 1e-12);
  ASSERT_EQ(agents.tracks.size(), 2U);
  EXPECT_EQ(agents.tracks[0].first, 2);
  EXPECT_EQ(agents.tracks[0].positions.size(), 3U);
  EXPECT_EQ(agents.tracks[1].first, 7);
  EXPECT_EQ(agents.tracks[1].positions.front(), Point2(5.0, 3.5));
}

TEST(FilmScene, LongFilmsAreThinnedOutAndCutAroundTheWorst) {
  const ReportEpisode thinned = film_episode(film_of(2000));
  const auto& all = thinned.scene.vehicles.front().series.t_s;
  EXPECT_LE(all.size(), static_cast<std::size_t>(kMostFilmFrames));
  EXPECT_EQ(all.front(), 0.0);
  EXPECT_GT(all.back(), 198.0);

  Film film = film_of(20000);
  film.events = {{100.0, {0.0, 0.0}, "near_agent", ""}, {1500.0, {0.0, 0.0}, "contact", ""}};
  const ReportEpisode cut = film_episode(film);
  const auto& times = cut.scene.vehicles.front().series.t_s;
  ASSERT_EQ(times.size(), static_cast<std::size_t>(kMostFilmFrames));
  EXPECT_NEAR(times[1] - times[0], kLongestPeriod, 1e-9);
  EXPECT_LT(times.front(), 1400.0);
  EXPECT_GT(times.back(), 1530.0);
  EXPECT_EQ(cut.scene.features.back().kind, "contact");
  for (const ReportFeature& f : cut.scene.features) EXPECT_NE(f.kind, "near_agent") << "cut off";
  EXPECT_EQ(cut.scene.agents.start_s, times.front());
}

TEST(FilmScene, AFilmWithoutFramesIsNoHarm) {
  EXPECT_TRUE(film_episode(Film{}).scene.vehicles.empty() ||
              film_episode(Film{}).scene.vehicles.front().series.t_s.empty());
}

TEST(FilmScene, IsWrittenIntoTheReport) {
  Report report;
  report.episodes = {film_episode(film_of(10))};
  const auto json = nlohmann::json::parse(*report_json(report));
  const auto& scene = json["episodes"][0]["scene"];
  EXPECT_EQ(json["episodes"][0]["note"], "a near-collision");
  EXPECT_EQ(scene["vehicles"][0]["series"]["t_s"].size(), 10U);
  EXPECT_EQ(scene["vehicles"][0]["outline"]["front_m"], 1.6);
  EXPECT_EQ(scene["agents"]["tracks"].dump(), "[[2,3,0.5],[7,3,0.5]]");
  // Six positions of two numbers of two bytes.
  EXPECT_EQ(scene["agents"]["positions"].get<std::string>().size(), (6U * 2U * 2U + 2U) / 3U * 4U);
  EXPECT_EQ(scene["agents"]["high_m"], 5.0);
}

}  // namespace
}  // namespace headland::apps
