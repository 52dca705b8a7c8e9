// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/turn.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "core/geometry/dubins.hpp"

namespace headland::coverage {
namespace {

const Footprint kOutline{2.0, 0.8, 1.4};
constexpr double kRadius = 3.0;

FreeSpace field(double headland, const Footprint& outline = kOutline) {
  return FreeSpace({{{{-30.0, -30.0}, {30.0, -30.0}, {30.0, headland}, {-30.0, headland}}, {}}},
                   {{{{0.0, -20.0}, {0.0, 0.0}}, 2.5}, {{{2.5, -20.0}, {2.5, 0.0}}, 2.5}}, outline,
                   0.1, 0.1);
}

TurnEnd row_end(double x, int row, double free_run) { return {{x, 0.0, 0.5 * kPi}, row, free_run}; }

TEST(Turn, AMirroredTrackLeadsBack) {
  RandomStream random(1, "curves");
  for (int i = 0; i < 200; ++i) {
    const Pose2 from{random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0),
                     random.uniform(-3.0, 3.0)};
    Turn turn{random.uniform(0.0, 3.0), random.uniform(0.0, 3.0), {}};
    for (int k = 0; k < 3; ++k) {
      turn.curve.add({random.uniform(-0.3, 0.3), random.uniform(-4.0, 4.0)});
    }
    const Path there = turn_path(from, turn);
    const Path back = turn_path(reversed(there.end_pose()), mirrored(turn));
    EXPECT_NEAR(there.length(), turn.length(), 1e-9);
    EXPECT_NEAR(back.length(), turn.length(), 1e-9);
    EXPECT_EQ(back.segments().size(), there.segments().size());
    EXPECT_NEAR((back.end_pose().position() - from.position()).norm(), 0.0, 1e-9);
    EXPECT_NEAR(std::abs(wrap_angle(back.end_pose().yaw - from.yaw)), kPi, 1e-9);
    const Path also_back = mirrored(there);
    EXPECT_NEAR((also_back.end_pose().position() - from.position()).norm(), 0.0, 1e-9);
    EXPECT_NEAR(also_back.length(), there.length(), 1e-9);
  }
}

TEST(TurnSearch, TakesTheOmegaWhereNothingElseIsAllowed) {
  const FreeSpace space = field(20.0);
  const auto turn =
      TurnSearch(space, kRadius).find(row_end(0.0, 0, 12.0), row_end(2.5, 1, 12.0), {}, {1.0, 0.0});
  ASSERT_TRUE(turn);
  EXPECT_EQ(turn->cusps(), 0);
  EXPECT_NEAR(turn->length(),
              kRadius * (3.0 * kPi - 4.0 * std::asin((2.0 * kRadius + 2.5) / (4.0 * kRadius))),
              1e-9);
}

TEST(TurnSearch, TheDearerTheGearTheFewerTheCusps) {
  const FreeSpace space = field(20.0);
  const TurnSearch search(space, kRadius);
  const TurnKinds all{true, true, true};
  int last = 9;
  for (const double per_cusp : {0.0, 1.0, 100.0}) {
    const auto turn =
        search.find(row_end(0.0, 0, 12.0), row_end(2.5, 1, 12.0), all, {1.0, per_cusp});
    ASSERT_TRUE(turn);
    EXPECT_LE(turn->cusps(), last);
    last = turn->cusps();
  }
  EXPECT_EQ(last, 0);
}

TEST(TurnSearch, ANarrowerHeadlandNeverMakesATurnCheaper) {
  const TurnKinds all{true, true, true};
  double last = 0.0;
  int found = 0;
  for (const double headland : {20.0, 12.0, 9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0}) {
    const FreeSpace space = field(headland);
    const auto end = [&](double x, int row, Travel travel) {
      TurnEnd e = row_end(x, row, 0.0);
      e.free_run = space.free_run(e.out, 12.0, TurnSearch::kLeadStep, travel, {row, -1});
      return e;
    };
    const auto turn =
        TurnSearch(space, kRadius)
            .find(end(0.0, 0, Travel::kForth), end(2.5, 1, Travel::kBack), all, {1.0, 2.0});
    const double cost = turn ? turn->length() + 2.0 * turn->cusps() : 1e9;
    EXPECT_GE(cost, last - 1e-9) << headland;
    last = cost;
    found += turn ? 1 : 0;
  }
  EXPECT_GE(found, 4);
  EXPECT_EQ(last, 1e9);  // at last nothing fits
}

}  // namespace
}  // namespace headland::coverage
