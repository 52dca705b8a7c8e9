// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/sight_history.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

SightHistory::Sight on_a_line(double time) { return {time, {2.0 * time, 1.0 - time}, {2.0, -1.0}}; }

TEST(SightHistory, LooksBackBetweenIrregularSights) {
  SightHistory history;
  for (const double time : {1.0, 1.13, 1.2, 1.6, 1.91}) history.add(on_a_line(time));
  SightHistory::Sight sight;
  for (const double time : {1.0, 1.05, 1.13, 1.4, 1.9, 1.91}) {
    ASSERT_TRUE(history.at(time, sight));
    EXPECT_NEAR((sight.position - on_a_line(time).position).norm(), 0.0, 1e-12) << time;
  }
  EXPECT_FALSE(history.at(0.9, sight));
  ASSERT_TRUE(history.at(2.5, sight));  // nothing newer is known
  EXPECT_EQ(sight.position, on_a_line(1.91).position);
}

TEST(SightHistory, HoldsAtLeastFourSecondsHoweverOftenSightsCome) {
  SightHistory history;
  for (int i = 0; i <= 10000; ++i) history.add(on_a_line(0.001 * i));
  EXPECT_NEAR(history.newest().time_s, 10.0, 1e-9);
  EXPECT_LT(history.oldest().time_s, 6.0);
  SightHistory::Sight sight;
  ASSERT_TRUE(history.at(7.2, sight));
  EXPECT_NEAR((sight.position - on_a_line(7.2).position).norm(), 0.0, 1e-9);
}

TEST(SightHistory, ASightOfTheSameTimeReplacesTheOneBefore) {
  SightHistory history;
  history.add(on_a_line(1.0));
  history.add({1.0, {5.0, 5.0}, {0.0, 0.0}});
  EXPECT_EQ(history.newest().position, Point2(5.0, 5.0));
  EXPECT_EQ(history.oldest().position, Point2(5.0, 5.0));
}

TEST(SightHistory, AClearedOneRemembersNothing) {
  SightHistory history;
  history.add(on_a_line(1.0));
  history.clear();
  SightHistory::Sight sight;
  EXPECT_TRUE(history.empty());
  EXPECT_FALSE(history.at(1.0, sight));
}

}  // namespace
}  // namespace headland
