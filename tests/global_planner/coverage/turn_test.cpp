// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/turn.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "core/geometry/dubins.hpp"
#include "core/model/steering_rate.hpp"

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
  const FreeSpace space = field(20.0, {0.3, 0.2, 0.8});
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

TEST(TurnSearch, ThreePointTurnsEndWhereTheyShallAndAreAsShortAsReedsSheppHasThem) {
  for (const double x : {2.5, -2.5, 5.0, -5.0, 5.5}) {
    const TurnEnd to{{x, 0.0, 0.5 * kPi}, -1, 0.0};
    const TurnEnd from{{0.0, 0.0, 0.5 * kPi}, -1, 0.0};
    const FreeSpace open({{{{-30.0, -30.0}, {30.0, -30.0}, {30.0, 30.0}, {-30.0, 30.0}}, {}}}, {},
                         kOutline, 0.1, 0.1);
    const auto turn = TurnSearch(open, kRadius).find(from, to, {false, false, true}, {1.0, 0.0});
    ASSERT_TRUE(turn);
    EXPECT_NEAR(turn->length(), kPi * kRadius, 1e-9);
    EXPECT_EQ(turn->cusps(), 2);
    const EndError miss = end_error(turn->curve, from.out, reversed(to.out));
    EXPECT_LT(miss.position, 1e-9);
    EXPECT_LT(miss.yaw, 1e-9);
  }
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

Vehicle slow_steered() {
  Vehicle v;
  v.wheelbase_m = 2.0;
  v.steering_rate_radps = 0.6;
  v.min_turning_radius_m = kRadius;
  v.footprint = kOutline;
  return v;
}

// The largest step of the curvature inside a gear [1/m].
double worst_step(const Turn& turn) {
  double worst = 0.0;
  double before = 0.0;
  bool forward = true;
  for (const CurvePiece& piece : turn.curve) {
    if ((piece.length > 0.0) == forward) {
      worst = std::max(worst, std::abs(piece.curvature - before));
    }
    before = piece.end_curvature();
    forward = piece.length > 0.0;
  }
  return forward ? std::max(worst, std::abs(before)) : worst;
}

TEST(TurnSearch, WhereThereIsRoomTheSteeringFollowsAtTheSpeedOfTheLeg) {
  const Vehicle vehicle = slow_steered();
  const FreeSpace space = field(20.0, vehicle.footprint);
  const TurnSearch search(space, vehicle, vehicle.turn_speed_mps);
  for (const TurnKinds kinds : {TurnKinds{true, false, false}, TurnKinds{false, true, false},
                                TurnKinds{false, false, true}}) {
    const auto turn =
        search.find(row_end(0.0, 0, 12.0), row_end(2.5, 1, 12.0), kinds, {1.0, 1.0, 10.0});
    ASSERT_TRUE(turn);
    EXPECT_LT(worst_step(*turn), 1e-9) << turn->curve.word();
    EXPECT_EQ(turn->lost_s, 0.0);
    EXPECT_GT(turn->smoothing_m, 0.0);
    for (const CurvePiece& piece : turn->curve) {
      EXPECT_LE(std::abs(piece.sharpness),
                sharpness_limit(vehicle, vehicle.turn_speed_mps) * (1.0 + 1e-12));
    }
  }
}

TEST(TurnSearch, ALowerSpeedIsTakenWhereItCostsLessAndItsTimeIsCounted) {
  const Vehicle vehicle = slow_steered();
  const FreeSpace space = field(20.0, vehicle.footprint);
  const TurnSearch search(space, vehicle, 3.0);
  const auto at = [&](double per_second) {
    return search.find(row_end(0.0, 0, 12.0), row_end(2.5, 1, 12.0), {}, {1.0, 1.0, per_second});
  };
  const auto short_one = at(0.0);
  const auto quick_one = at(100.0);
  ASSERT_TRUE(short_one && quick_one);
  EXPECT_GT(short_one->lost_s, 1.0);
  EXPECT_EQ(quick_one->lost_s, 0.0);
  EXPECT_LT(short_one->length(), quick_one->length());
  EXPECT_LT(worst_step(*short_one), 1e-9);
}

TEST(TurnSearch, OnlyWhereNoSmoothTurnFitsTheCurvatureSteps) {
  const Vehicle vehicle = slow_steered();
  int smooth = 0;
  int found = 0;
  for (double headland = 14.0; headland > 4.0; headland -= 0.25) {
    const FreeSpace space = field(headland, vehicle.footprint);
    const auto end = [&](double x, int row, Travel travel) {
      TurnEnd e = row_end(x, row, 0.0);
      e.free_run = space.free_run(e.out, 12.0, TurnSearch::kLeadStep, travel, {row, -1});
      return e;
    };
    const TurnEnd from = end(0.0, 0, Travel::kForth);
    const TurnEnd to = end(2.5, 1, Travel::kBack);
    const auto turn = TurnSearch(space, vehicle, 1.0).find(from, to, {}, {1.0, 1.0, 1.0});
    const auto plain = TurnSearch(space, kRadius).find(from, to, {}, {1.0, 1.0, 1.0});
    EXPECT_EQ(turn.has_value(), plain.has_value()) << headland;
    if (!turn) continue;
    ++found;
    smooth += worst_step(*turn) < 1e-9 ? 1 : 0;
    EXPECT_GE(turn->length(), plain->length() - 1e-9);
  }
  EXPECT_GT(smooth, found / 2);
}

TEST(TurnSearch, QuickSteeringNeedsNoClothoids) {
  Vehicle vehicle = slow_steered();
  vehicle.steering_rate_radps = 50.0;
  const FreeSpace space = field(20.0, vehicle.footprint);
  const auto turn = TurnSearch(space, vehicle, 1.0)
                        .find(row_end(0.0, 0, 12.0), row_end(2.5, 1, 12.0), {}, {1.0, 1.0, 1.0});
  ASSERT_TRUE(turn);
  for (const CurvePiece& piece : turn->curve) EXPECT_EQ(piece.sharpness, 0.0);
}

}  // namespace
}  // namespace headland::coverage
