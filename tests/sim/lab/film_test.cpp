// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/film.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

// Episodes of one row with one number; an episode is bad from 1 on, worse from 2 on.
std::vector<std::vector<Episode>> episodes(const std::vector<std::vector<double>>& cells) {
  std::vector<std::vector<Episode>> all;
  for (const auto& cell : cells) {
    all.emplace_back();
    for (const double value : cell) all.back().push_back({{{value}}});
  }
  return all;
}

FilmReason at_least(const char* what, double value) {
  return {what, [value](const Episode& e) { return e.rows.front().front() >= value; }};
}
const std::vector<FilmReason> kReasons = {at_least("worse", 2.0), at_least("bad", 1.0)};

using Choices = std::vector<std::pair<EpisodeKey, std::string>>;
Choices pairs(const std::vector<FilmChoice>& chosen) {
  Choices result;
  for (const FilmChoice& c : chosen) result.emplace_back(c.key, c.why);
  return result;
}

TEST(ChooseFilms, TakesTheFirstForEachReasonOfEachPlanner) {
  const auto all = episodes({{0, 1, 2}, {0, 1, 2}, {0, 0, 0}});
  EXPECT_EQ(pairs(choose_films(all, {"a", "a", "b"}, kReasons, 4)),
            (Choices{{{0, 2}, "worse"}, {{0, 1}, "bad"}, {{2, 0}, "the first"}}));
}

TEST(ChooseFilms, ShowsNoEpisodeTwiceAndEachPlannerAtLeastOnce) {
  const auto all = episodes({{2}, {0}});
  EXPECT_EQ(pairs(choose_films(all, {"a", "b"}, kReasons, 6)),
            (Choices{{{0, 0}, "worse"}, {{1, 0}, "the first"}}));
  EXPECT_EQ(choose_films(all, {"a", "b"}, kReasons, 1).size(), 2U);
}

TEST(ChooseFilms, ChoosesNoneWhereNoneIsAskedFor) {
  EXPECT_TRUE(choose_films(episodes({{2}}), {"a"}, kReasons, 0).empty());
  EXPECT_TRUE(choose_films({}, {}, kReasons, 3).empty());
}

TEST(OutlineGap, IsTheDistanceFromTheRectangleLessTheRadius) {
  const Footprint outline{2.0, 1.0, 2.0};
  const Pose2 north{10.0, 0.0, 1.5707963267948966};
  EXPECT_NEAR(outline_gap(outline, north, {10.0, 5.0}, 0.5), 2.5, 1e-12) << "ahead";
  EXPECT_NEAR(outline_gap(outline, north, {10.0, -4.0}, 0.5), 2.5, 1e-12) << "behind";
  EXPECT_NEAR(outline_gap(outline, north, {7.0, 0.0}, 0.5), 1.5, 1e-12) << "beside";
  EXPECT_NEAR(outline_gap(outline, north, {14.0, 6.0}, 0.0), 5.0, 1e-12) << "off a corner";
  EXPECT_NEAR(outline_gap(outline, north, {10.0, 1.0}, 0.5), -0.5, 1e-12) << "inside";
}

}  // namespace
}  // namespace headland
