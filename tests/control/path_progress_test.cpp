// SPDX-License-Identifier: Apache-2.0
#include "control/path_progress.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

// 10 m forwards and 6 m of them back in reverse, 2 m forwards again.
Path there_and_back() {
  Path path;
  path.append({{0.0, 0.0, 0.0}, 0.0, 10.0, Gear::kForward, 0});
  path.append({{10.0, 0.0, 0.0}, 0.0, 6.0, Gear::kReverse, 0});
  path.append({{4.0, 0.0, 0.0}, 0.0, 2.0, Gear::kForward, 0});
  return path;
}

TEST(PathProgress, StaysOnTheSegmentUnderWayWhereThePathRunsBackOnItself) {
  const Path path = there_and_back();
  PathProgress progress;
  progress.start(path);
  progress.move_to(9.5);
  EXPECT_NEAR(progress.nearest({9.9, 0.1}, 5.0).s, 9.9, 1e-12);
  EXPECT_FALSE(progress.on_last());
  progress.next_segment();
  EXPECT_EQ(progress.number(), 1);
  EXPECT_EQ(progress.segment().gear, Gear::kReverse);
  EXPECT_NEAR(progress.nearest({9.9, 0.1}, 5.0).s, 10.1, 1e-12);
  progress.next_segment();
  EXPECT_TRUE(progress.on_last());
}

TEST(PathProgress, NeverDecreasesAndIsNeverOnACusp) {
  const Path path = there_and_back();
  PathProgress progress;
  progress.start(path);
  progress.move_to(5.0);
  progress.move_to(3.0);
  EXPECT_EQ(progress.s(), 5.0);
  progress.move_to(50.0);
  EXPECT_LT(progress.s(), 10.0);
  EXPECT_EQ(path.at(progress.s()).segment, 0);
  progress.next_segment();
  progress.move_to(10.0);
  EXPECT_GT(progress.s(), 10.0);
  EXPECT_EQ(path.at(progress.s() - 1e-6).segment, 1);
}

TEST(PathProgress, WhatRemainsGoesThroughZeroBesideTheEndInBothGears) {
  const Path path = there_and_back();
  PathProgress progress;
  progress.start(path);
  EXPECT_NEAR(progress.remaining({7.0, 0.3, 0.0}, 7.0), 3.0, 1e-12);
  EXPECT_NEAR(progress.remaining({9.98, 0.5, 0.1}, 9.98), 0.02, 1e-8);
  EXPECT_NEAR(progress.remaining({10.03, 0.5, 0.1}, 10.0), -0.03, 1e-8);
  progress.next_segment();
  EXPECT_NEAR(progress.remaining({4.02, -0.5, 0.0}, 15.98), 0.02, 1e-8);
  EXPECT_NEAR(progress.remaining({3.97, -0.5, 0.0}, 16.0), -0.03, 1e-8);
}

}  // namespace
}  // namespace headland
