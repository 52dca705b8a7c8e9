// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "global_planner/roadmap/internal/drive_rules.hpp"
#include "global_planner/roadmap/internal/grid_distance.hpp"
#include "global_planner/roadmap/internal/outline_fit.hpp"
#include "global_planner/roadmap/internal/shorten.hpp"
#include "tests/global_planner/roadmap/yards.hpp"

namespace headland::roadmap {
namespace {

using test::box;
using test::yard;

TEST(OutlineFit, NeverPassesAnArcThatLeavesTheArea) {
  const Vehicle vehicle = test::small_tractor();
  const Region area = yard(12.0, {box(5.5, 5.5, 6.5, 6.5)});
  const OutlineFit fit(area, vehicle.footprint, 0.1);
  RandomStream random(1, "arcs");
  int passed = 0;
  for (int i = 0; i < 3000; ++i) {
    const Pose2 from{random.uniform(0.0, 12.0), random.uniform(0.0, 12.0),
                     random.uniform(-kPi, kPi)};
    const CurvePiece piece{random.uniform(-0.4, 0.4), random.uniform(-6.0, 6.0)};
    if (!fit.fits(from, piece)) continue;
    ++passed;
    for (int k = 0; k <= 200; ++k) {
      const Pose2 pose = advance(from, piece.curvature, piece.length * k / 200);
      ASSERT_TRUE(area.contains(pose, vehicle.footprint)) << "arc " << i;
    }
  }
  EXPECT_GT(passed, 100);
}

TEST(OutlineFit, FindsASpikeThatALongStraightRunsOver) {
  const Region area = yard(50.0, {box(25.0, 20.0, 25.01, 24.6)});
  const OutlineFit fit(area, {2.2, 0.8, 1.4}, 0.1);
  EXPECT_FALSE(fit.fits({5.0, 25.0, 0.0}, CurvePiece{0.0, 40.0}));
  EXPECT_TRUE(fit.fits({5.0, 25.5, 0.0}, CurvePiece{0.0, 40.0}));
  EXPECT_FALSE(fit.fits({45.0, 25.0, 0.0}, CurvePiece{0.0, -40.0}));
}

TEST(GridDistance, IsAboutTheDistanceOnOpenGround) {
  const Region area = yard(40.0, {});
  GridDistance around(area, 0.7, 0.5, {20.0, 20.0});
  RandomStream random(1, "grid");
  for (int i = 0; i < 200; ++i) {
    const Point2 p{random.uniform(1.0, 39.0), random.uniform(1.0, 39.0)};
    const double straight = (p - Point2(20.0, 20.0)).norm();
    EXPECT_GE(around.at(p), straight - 1.3);
    EXPECT_LE(around.at(p), straight * 1.083 + 0.5);  // eight directions: at most 8.2 % longer
  }
}

TEST(GridDistance, GoesRoundWallsAndThroughGatesOfTheDisc) {
  const Region with_gate = yard(40.0, {box(0.0, 19.0, 30.0, 21.0), box(31.5, 19.0, 40.0, 21.0)});
  GridDistance around(with_gate, 0.7, 0.5, {5.0, 30.0});
  EXPECT_GT(around.at({5.0, 10.0}), 50.0);  // 25 m along the wall and back
  EXPECT_LT(around.at({5.0, 10.0}), 62.0);
  GridDistance wider(with_gate, 1.2, 0.5, {5.0, 30.0});
  EXPECT_TRUE(std::isinf(wider.at({5.0, 10.0})));
  EXPECT_TRUE(std::isinf(wider.at({-50.0, 10.0})));
}

TEST(Joins, AreExactAndSortedAndKeepToTheGear) {
  RandomStream random(1, "joins");
  DriveRules rules{2.5, true, 1.5, 3.0, 0.05};
  for (int i = 0; i < 500; ++i) {
    const Pose2 from{random.uniform(-8.0, 8.0), random.uniform(-8.0, 8.0),
                     random.uniform(-kPi, kPi)};
    const Pose2 to{random.uniform(-8.0, 8.0), random.uniform(-8.0, 8.0), random.uniform(-kPi, kPi)};
    double last = 0.0;
    rules.reverses = i % 2 == 0;
    for (const Join& join : joins(rules, from, to)) {
      const EndError error = end_error(join.curve, from, to);
      EXPECT_LT(error.position + error.yaw, 1e-7);
      EXPECT_GE(join.cost, last);
      EXPECT_GE(join.cost, rules.open_distance(from, to) - 1e-9);
      last = join.cost;
      for (const CurvePiece& piece : join.curve) {
        EXPECT_TRUE(rules.reverses || piece.length > 0.0);
      }
    }
  }
}

TEST(Shortened, TakesADetourOutButKeepsTheEnds) {
  const Region area = yard(40.0, {});
  const Vehicle vehicle = test::small_tractor();
  const OutlineFit fit(area, vehicle.footprint, 0.1);
  const DriveRules rules{2.5, true, 1.5, 3.0, 0.05};
  const Pose2 from{10.0, 10.0, 0.0};
  PathBuilder builder;
  Curve detour;
  detour.add({0.4, 3.0});
  detour.add({0.0, 5.0});
  detour.add({-0.4, 6.0});
  detour.add({0.0, 5.0});
  detour.add({0.4, 3.0});
  builder.add(from, detour);
  const Pose2 to = detour.end_pose(from);
  const Path path = shortened(builder.path(), rules, fit);
  EXPECT_EQ(test::complaint(path, from, to, area, vehicle), "");
  EXPECT_NEAR(path.length(), rules.open_distance(from, to), 1e-6);
}

TEST(Shortened, LeavesAPathThatHasNoRoomAsItIs) {
  const Region lane({box(0.0, 0.0, 30.0, 1.7)});
  const OutlineFit fit(lane, {2.2, 0.8, 1.4}, 0.1);
  const DriveRules rules{2.5, true, 1.5, 3.0, 0.05};
  PathBuilder builder;
  builder.add({5.0, 0.85, 0.0}, CurvePiece{0.0, 20.0});
  const Path path = shortened(builder.path(), rules, fit);
  EXPECT_EQ(path.pieces().size(), 1u);
  EXPECT_NEAR(path.length(), 20.0, 1e-9);
}

}  // namespace
}  // namespace headland::roadmap
