// SPDX-License-Identifier: Apache-2.0
#include "local_planner/mcts/internal/tree.hpp"

#include <gtest/gtest.h>

#include "tests/local_planner/planner_laws.hpp"

namespace headland::mcts {
namespace {

constexpr double kRadius = 1.4;
constexpr int kAll = 1 + Manoeuvres::kCount + Manoeuvres::kCount * Manoeuvres::kCount;

// Two steps, looked at until all of them have been.
struct TwoSteps {
  explicit TwoSteps(const ClearanceMap* map) : map_(map) {
    config_.depth_count = 2;
    config_.exploration_ratio = 1000.0;
    forecasts_[0].set({}, {}, {0.0, 0.0}, kRadius, config_);
  }

  int look_at_all(Tree& tree) const {
    const Task task{&moves, &config_, &forecasts_, map_, kRadius, 0.7, {9.0, 0.0}};
    tree.begin(task);
    for (int i = 0; i < 5000; ++i) tree.expand(task);
    return tree.size();
  }

  Manoeuvres moves{test::field_robot(), MctsConfig{}.step_s};

 private:
  const ClearanceMap* map_;
  MctsConfig config_;
  std::vector<Forecast> forecasts_{1};
};

TEST(Tree, WhatAMapRefusedIsTriedAgainInATreeThatIsKept) {
  const ClearanceMap wall = ClearanceMap::of({test::box(-5.0, 1.7, 20.0, 2.1)});
  const TwoSteps walled(&wall);
  const TwoSteps open(nullptr);
  VehicleState state;
  state.speed = 1.0;
  const Motion root = open.moves.from(state);
  constexpr int kHardLeft = (Manoeuvres::kTurns - 1) * Manoeuvres::kSpeeds + 1;

  Tree tree;
  tree.reset(root);
  EXPECT_LT(walled.look_at_all(tree), kAll) << "no way farther to the left";
  const Action on = open.moves.action(root, kHardLeft, 1.0);
  const int kept = tree.advance(kHardLeft, open.moves.drive(root, on), 0.5);
  EXPECT_GT(kept, 1);
  EXPECT_LT(kept, 1 + Manoeuvres::kCount);
  EXPECT_EQ(open.look_at_all(tree), kAll) << "all, and none twice";
}

TEST(Tree, IsNotKeptByAnActionThatItDoesNotHave) {
  Tree tree;
  EXPECT_EQ(tree.advance(0, {}, 0.5), 0);
  tree.reset({});
  EXPECT_EQ(tree.advance(0, {}, 0.5), 0);
}

}  // namespace
}  // namespace headland::mcts
