// SPDX-License-Identifier: Apache-2.0
#include "global_planner/coverage/internal/free_space.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland::coverage {
namespace {

const Footprint kOutline{2.0, 0.8, 1.4};

std::vector<Polygon> area_with_pond() {
  return {{{{0.0, 0.0}, {40.0, 0.0}, {40.0, 30.0}, {0.0, 30.0}},
           {{{30.0, 5.0}, {30.0, 12.0}, {36.0, 12.0}, {36.0, 5.0}}}}};
}

std::vector<RowBody> three_rows() {
  return {{{{8.0, 6.0}, {8.0, 22.0}}, 2.4},
          {{{10.4, 7.0}, {10.4, 23.0}}, 2.4},
          {{{14.0, 6.0}, {20.0, 14.0}, {21.0, 22.0}}, 2.4}};
}

FreeSpace space(double margin) {
  return FreeSpace(area_with_pond(), three_rows(), kOutline, margin, margin);
}

Polygon outline_at(const Pose2& pose, const Footprint& f, double margin) {
  const double half = 0.5 * f.width_m + margin;
  return {{pose * Point2(f.front_m + margin, -half), pose * Point2(f.front_m + margin, half),
           pose * Point2(-f.rear_m - margin, half), pose * Point2(-f.rear_m - margin, -half)},
          {}};
}

double total_area(const std::vector<Polygon>& polygons) {
  double sum = 0.0;
  for (const Polygon& polygon : polygons) sum += area(polygon);
  return sum;
}

Pose2 random_pose(RandomStream& random) {
  return {random.uniform(-1.0, 41.0), random.uniform(-1.0, 31.0), random.uniform(-kPi, kPi)};
}

TEST(FreeSpace, AgreesWithPolygonsOnRandomPoses) {
  const double margin = 0.1;
  const FreeSpace free = space(margin);
  RandomStream random(5, "poses");
  int fitting = 0;
  for (int i = 0; i < 4000; ++i) {
    const Pose2 pose = random_pose(random);
    const std::vector<Polygon> outline{outline_at(pose, kOutline, margin)};
    double outside = total_area(subtract(outline, area_with_pond()));
    for (const RowBody& row : three_rows()) {
      for (std::size_t k = 1; k < row.line.size(); ++k) {
        outside += total_area(
            intersect(outline, widen({row.line[k - 1], row.line[k]}, row.spacing - kSlit)));
      }
    }
    if (outside > 0.0 && outside < 1e-6) continue;  // touching
    EXPECT_EQ(free.fits(pose, Travel::kForth, {}), outside == 0.0) << pose.x << " " << pose.y;
    fitting += outside == 0.0 ? 1 : 0;
  }
  EXPECT_GT(fitting, 400);
  EXPECT_LT(fitting, 3600);
}

TEST(FreeSpace, BackSwapsTheEndsAndBothAsksForBoth) {
  const FreeSpace free = space(0.1);
  RandomStream random(6, "poses");
  for (int i = 0; i < 2000; ++i) {
    const Pose2 pose = random_pose(random);
    const bool forth = free.fits(pose, Travel::kForth, {});
    const bool back = free.fits(pose, Travel::kBack, {});
    EXPECT_EQ(back, free.fits(reversed(pose), Travel::kForth, {}));
    EXPECT_EQ(free.fits(pose, Travel::kBoth, {}), forth && back);
  }
}

TEST(FreeSpace, AnOwnRowMayBeInsideButNotCrossed) {
  const FreeSpace free = space(0.1);
  const Pose2 inside{8.0, 14.0, 0.5 * kPi};
  EXPECT_FALSE(free.fits(inside, Travel::kForth, {}));
  EXPECT_TRUE(free.fits(inside, Travel::kForth, {0, -1}));
  EXPECT_FALSE(free.fits(inside, Travel::kForth, {1, -1}));
  EXPECT_FALSE(free.fits({8.0, 14.0, 0.0}, Travel::kForth, {0, 1}));
  EXPECT_FALSE(free.fits({6.4, 14.0, 0.5 * kPi}, Travel::kForth, {0, -1}));
  EXPECT_EQ(free.row_at({8.5, 10.0}), 0);
  EXPECT_EQ(free.row_at({3.0, 10.0}), -1);
}

TEST(FreeSpace, WhatFitsAlongACurveFitsAtEveryPointOfIt) {
  const FreeSpace with_margin = space(0.1);
  const FreeSpace bare = space(0.0);
  RandomStream random(7, "curves");
  int fitting = 0;
  for (int i = 0; i < 6000; ++i) {
    const Pose2 from = random_pose(random);
    Curve curve;
    for (int k = 0; k < 3; ++k) {
      curve.add(
          {random.uniform() < 0.3 ? 0.0 : random.uniform(-0.5, 0.5), random.uniform(-1.5, 4.0)});
    }
    const bool fits = with_margin.fits(from, curve, Travel::kForth, {});
    bool everywhere = true;
    Pose2 start = from;
    for (const CurvePiece& piece : curve) {
      for (int k = 0; k <= 200; ++k) {
        const Pose2 pose = advance(start, piece.curvature, piece.length * k / 200);
        everywhere = everywhere && bare.fits(pose, Travel::kForth, {});
      }
      start = advance(start, piece.curvature, piece.length);
    }
    if (fits) {
      EXPECT_TRUE(everywhere);
    }
    fitting += fits ? 1 : 0;
  }
  EXPECT_GT(fitting, 300);
}

TEST(FreeSpace, AStraightLineIsSweptExactly) {
  // A row's end a hand's breadth beside the track: no sample need see it, the sweep does.
  const FreeSpace free({{{{0.0, 0.0}, {40.0, 0.0}, {40.0, 30.0}, {0.0, 30.0}}, {}}},
                       {{{{20.0, 10.0}, {20.0, 10.05}}, 0.06}}, kOutline, 0.0, 0.0);
  EXPECT_FALSE(free.fits_straight({5.0, 10.0, 0.0}, 30.0, Travel::kForth, {}));
  EXPECT_FALSE(free.fits_straight({35.0, 10.0, 0.0}, -30.0, Travel::kForth, {}));
  EXPECT_TRUE(free.fits_straight({5.0, 8.0, 0.0}, 30.0, Travel::kForth, {}));
}

TEST(FreeSpace, TheFreeRunEndsAtTheBorder) {
  const FreeSpace free = space(0.1);
  const Pose2 from{3.0, 27.0, 0.0};
  EXPECT_DOUBLE_EQ(free.free_run(from, 100.0, 0.5, Travel::kForth, {}), 34.5);
  EXPECT_DOUBLE_EQ(free.free_run(from, 12.0, 0.5, Travel::kForth, {}), 12.0);
  EXPECT_DOUBLE_EQ(free.free_run({0.5, 27.0, 0.0}, 12.0, 0.5, Travel::kForth, {}), -1.0);
  EXPECT_NEAR(free.room_ahead(from, 100.0, {}), 37.0, 0.11);
}

}  // namespace
}  // namespace headland::coverage
