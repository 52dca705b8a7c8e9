// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "global_planner/coverage/internal/row_line.hpp"
#include "global_planner/coverage/transitions.hpp"

namespace headland {
namespace {

Row bent_row() { return {"bent", {{0.0, 0.0}, {30.0, 0.0}, {55.0, 5.0}, {80.0, 16.0}}}; }

TEST(RowPath, AStraightRowIsOnePiece) {
  const Path path = row_path({"r", {{1.0, 2.0}, {1.0, 42.0}}}, 0, 3.0);
  ASSERT_EQ(path.pieces().size(), 1U);
  EXPECT_DOUBLE_EQ(path.length(), 40.0);
  EXPECT_NEAR(path.start_pose().yaw, 0.5 * kPi, 1e-12);
}

TEST(RowPath, TheNoiseOfASurveyIsNotDriven) {
  RandomStream noise(7, "survey");
  Row row{"noisy", {}};
  for (int i = 0; i <= 50; ++i) row.line.emplace_back(2.0 * i, noise.uniform(-0.02, 0.02));
  EXPECT_EQ(row_path(row, 0, 3.0).pieces().size(), 1U);
}

TEST(RowPath, CornersBecomeArcsNoTighterThanTheRadius) {
  const double radius = 4.0;
  const Path path = row_path(bent_row(), 0, radius);
  EXPECT_EQ(path.pieces().size(), 5U);
  double turned = 0.0;
  for (const PathPiece& piece : path.pieces()) {
    EXPECT_LE(std::abs(piece.curvature), 1.0 / radius + 1e-12);
    turned += piece.curvature * piece.length;
  }
  EXPECT_NEAR(turned, std::atan2(11.0, 25.0), 1e-9);
  for (const PathSample& sample : path.sample(0.1)) {
    double nearest = 1e9;
    const Polyline& line = bent_row().line;
    for (std::size_t i = 1; i < line.size(); ++i) {
      nearest =
          std::min(nearest, distance_to_segment(sample.pose.position(), line[i - 1], line[i]));
    }
    EXPECT_LE(nearest, coverage::kSurveyTolerance + 1e-9);
  }
}

TEST(RowPath, BothDirectionsShareTheTrack) {
  const Path there = row_path(bent_row(), 0, 4.0);
  const Path back = row_path(bent_row(), 1, 4.0);
  EXPECT_NEAR(there.length(), back.length(), 1e-9);
  for (double s = 0.0; s <= there.length(); s += 0.5) {
    const Pose2 a = there.at(s).pose;
    const Pose2 b = back.at(there.length() - s).pose;
    EXPECT_NEAR((a.position() - b.position()).norm(), 0.0, 1e-9);
    EXPECT_NEAR(std::abs(wrap_angle(a.yaw - b.yaw)), kPi, 1e-9);
  }
}

TEST(RowPath, ABendTooTightForTheVehicleIsCut) {
  const Row row{"kinked", {{0.0, 0.0}, {20.0, 0.0}, {20.4, 0.4}, {20.8, 0.0}, {40.0, 0.0}}};
  const Path path = row_path(row, 0, 6.0);
  EXPECT_NEAR((path.end_pose().position() - Point2(40.0, 0.0)).norm(), 0.0, 1e-9);
  for (const PathPiece& piece : path.pieces()) EXPECT_LE(std::abs(piece.curvature), 1.0 / 6.0);
}

TEST(Simplified, KeepsEveryPointWithinTheTolerance) {
  RandomStream random(3, "line");
  for (int run = 0; run < 50; ++run) {
    Polyline line;
    double y = 0.0;
    for (int i = 0; i < 40; ++i) line.emplace_back(i, y += random.uniform(-0.1, 0.1));
    const Polyline few = coverage::simplified(line, 0.2);
    EXPECT_LT(few.size(), line.size());
    for (const Point2& p : line) {
      double nearest = 1e9;
      for (std::size_t i = 1; i < few.size(); ++i) {
        nearest = std::min(nearest, distance_to_segment(p, few[i - 1], few[i]));
      }
      EXPECT_LE(nearest, 0.2);
    }
  }
}

}  // namespace
}  // namespace headland
