// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/polito/orchard.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

TEST(ParametricOrchardConfig, GivesTheAlleysAndThePitchOfFigure4) {  // (004) Eqs. 3-4
  const ParametricOrchardConfig orchard;
  EXPECT_EQ(orchard.alleys(), 10);
  EXPECT_DOUBLE_EQ(orchard.pitch(), 10.0);
  EXPECT_DOUBLE_EQ(orchard.alley_x(0), 5.0);
  EXPECT_DOUBLE_EQ(orchard.alley_x(9), 95.0);
  EXPECT_DOUBLE_EQ(orchard.tree_row_x(0), 10.0);
}

TEST(PlanOrchard, DrivesThePathOfFigure6) {
  const auto plan = plan_orchard({});
  ASSERT_TRUE(plan);
  EXPECT_NEAR(plan->path.length(), 980.0 - 160.0 + 45.0 * kPi, 1e-9);  // 961.4 m
  EXPECT_LT((plan->path.start_pose().position() - Point2(5.0, 0.0)).norm(), 1e-9);
  EXPECT_LT((plan->path.end_pose().position() - Point2(95.0, 0.0)).norm(), 1e-6);
  // Start, two ends of each alley, an apex between two alleys, goal.
  EXPECT_EQ(plan->checkpoints.size(), 1u + 20u + 9u + 1u);
  EXPECT_EQ(std::count(plan->legs.begin(), plan->legs.end(), LegKind::kRow), 10);
  EXPECT_EQ(std::count(plan->legs.begin(), plan->legs.end(), LegKind::kTurn), 9);
}

TEST(PlanOrchard, PassesThroughItsCheckpointsAndOutsideTheTrees) {
  ParametricOrchardConfig orchard;
  for (const int rows : {1, 4, 9, 16}) {
    orchard.tree_rows_count = rows;
    orchard.row_start_m = 30.0;
    orchard.row_length_m = 40.0;
    const auto plan = plan_orchard(orchard);
    ASSERT_TRUE(plan) << rows;
    for (const Point2& p : plan->checkpoints) {
      EXPECT_LT(plan->path.project(p, 0.0, plan->path.length()).distance, 1e-6);
    }
    const OrchardGrid grid = rasterize(orchard, 16.0);
    for (const PathSample& sample : plan->path.sample(0.2)) {
      const int column = std::min(static_cast<int>(sample.pose.x / grid.cell_m), grid.columns - 1);
      const int row = std::min(static_cast<int>(sample.pose.y / grid.cell_m), grid.rows - 1);
      ASSERT_EQ(grid.at(std::max(column, 0), std::max(row, 0)), 0) << sample.s;
    }
    // An odd number of alleys ends on the far side of the field.
    EXPECT_NEAR(plan->path.end_pose().y, rows % 2 == 0 ? 100.0 : 0.0, 1e-6);
  }
}

TEST(PlanOrchard, RefusesAHairpinLongerThanTheHeadland) {
  ParametricOrchardConfig orchard;
  orchard.row_start_m = 4.0;
  const auto plan = plan_orchard(orchard);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::kTurnDoesNotFit);
}

TEST(PlanOrchard, RefusesRowsThatDoNotFitTheField) {
  ParametricOrchardConfig wide;
  wide.row_width_m = 10.0;
  EXPECT_EQ(plan_orchard(wide).error().code, ErrorCode::kBadGeometry);
  ParametricOrchardConfig long_rows;
  long_rows.row_length_m = 95.0;
  EXPECT_EQ(plan_orchard(long_rows).error().code, ErrorCode::kBadGeometry);
}

TEST(Rasterize, OccupiesTheAreaOfTheTreeRows) {  // A = w l each
  const ParametricOrchardConfig orchard;
  const OrchardGrid grid = rasterize(orchard, 4.0);
  EXPECT_EQ(grid.columns, 200);
  EXPECT_EQ(grid.rows, 200);
  const auto occupied = std::count(grid.cells.begin(), grid.cells.end(), 1);
  EXPECT_EQ(occupied, 9 * 2 * 80 * 4);
}

TEST(ArcThrough, PassesItsThreePointsInEitherSense) {
  for (const double side : {1.0, -1.0}) {
    const Point2 from(1.0, 2.0);
    const Point2 apex(2.0, 2.0 + 3.0 * side);
    const Point2 to(4.0, 2.0 + 1.0 * side);
    const auto arc = arc_through(from, apex, to);
    ASSERT_TRUE(arc);
    EXPECT_GT(-side * arc->curvature, 0.0);
    Path path;
    path.append({arc->start, arc->curvature, arc->length, Gear::kForward, 0});
    EXPECT_LT((path.start_pose().position() - from).norm(), 1e-12);
    EXPECT_LT((path.end_pose().position() - to).norm(), 1e-12);
    EXPECT_LT(path.project(apex, 0.0, path.length()).distance, 1e-12);
  }
}

TEST(ArcThrough, IsNothingForPointsOnALine) {
  EXPECT_FALSE(arc_through({0, 0}, {1, 1}, {2, 2}));
  EXPECT_FALSE(arc_through({0, 0}, {1, 1}, {0, 0}));
}

TEST(Waypoints, StandAtEqualDistancesAndIncludeBothEnds) {
  const auto plan = plan_orchard({});
  ASSERT_TRUE(plan);
  const std::vector<Point2> points = waypoints(plan->path, 0.33);
  EXPECT_EQ(points.size(), 2914u);
  EXPECT_LT((points.back() - Point2(95.0, 0.0)).norm(), 1e-6);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double gap = (points[i] - points[i - 1]).norm();
    EXPECT_LE(gap, 0.3301);
    EXPECT_GE(gap, 0.3299);
  }
}

}  // namespace
}  // namespace headland
