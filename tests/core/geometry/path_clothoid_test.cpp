// SPDX-License-Identifier: Apache-2.0
// The laws of Path on paths of straights, arcs and clothoids in both gears.
#include <limits>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "core/geometry/path.hpp"
#include "tests/support/curve_constructions.hpp"

namespace headland {
namespace {

PathPiece random_piece(RandomStream& random, const Pose2& start, int leg) {
  PathPiece piece;
  piece.start = start;
  piece.length = random.uniform(0.2, 12.0);
  piece.gear = random.index(3) == 0 ? Gear::kReverse : Gear::kForward;
  piece.leg = leg;
  const int kind = random.index(4);
  if (kind > 0) piece.curvature = random.uniform(-0.5, 0.5);
  if (kind > 1) piece.sharpness = (random.uniform(-0.5, 0.5) - piece.curvature) / piece.length;
  return piece;
}

Path random_path(RandomStream& random, int pieces) {
  Path path;
  Pose2 here = test::random_pose(random, 10.0);
  for (int i = 0; i < pieces; ++i) {
    path.append(random_piece(random, here, i));
    here = path.end_pose();
  }
  return path;
}

TEST(PathOfClothoids, SamplesAgreeWithDrivingItsCurvatureInSmallSteps) {
  RandomStream random(1, "clothoid path");
  for (int i = 0; i < 20; ++i) {
    const Path path = random_path(random, 8);
    double begin_s = 0.0;
    for (const PathPiece& piece : path.pieces()) {
      constexpr int kSteps = 4000;
      const double step = piece.length / kSteps;
      Pose2 driven = piece.start;
      for (int k = 0; k < kSteps; ++k) {
        const double middle = begin_s + (k + 0.5) * step;
        driven = advance(driven, path.at(middle).curvature, sign(piece.gear) * step);
        if (k % 400 != 399) continue;
        const Pose2 sampled = path.at(std::nextafter(begin_s + (k + 1) * step, 0.0)).pose;
        ASSERT_LT((sampled.position() - driven.position()).norm(), 1e-6);
        ASSERT_LT(std::abs(sampled.yaw - driven.yaw), 1e-9);
      }
      begin_s += piece.length;
    }
  }
}

TEST(PathOfClothoids, CurvatureIsThatOfTheSampledHeadings) {
  RandomStream random(2, "clothoid path");
  const Path path = random_path(random, 30);
  const double h = 1e-4;
  for (double s = h; s + h < path.length(); s += 0.37) {
    const PathSample a = path.at(s - h);
    const PathSample b = path.at(s + h);
    if (a.leg != b.leg) continue;
    const PathSample middle = path.at(s);
    ASSERT_NEAR((b.pose.yaw - a.pose.yaw) / (2.0 * h), sign(middle.gear) * middle.curvature, 1e-8);
  }
}

TEST(PathOfClothoids, ProjectionsAgreeWithTheNearestOfDenseSamples) {
  RandomStream random(3, "clothoid path");
  for (int i = 0; i < 300; ++i) {
    const Path path = random_path(random, 1 + random.index(5));
    const Point2 p = path.at(random.uniform(0.0, path.length())).pose *
                     Point2(random.uniform(-6.0, 6.0), random.uniform(-6.0, 6.0));
    const double a = random.uniform(0.0, path.length());
    const double b = random.uniform(0.0, path.length());
    const double low = i % 2 == 0 ? 0.0 : std::min(a, b);
    const double high = i % 2 == 0 ? path.length() : std::max(a, b);
    const Projection found = path.project(p, low, high);
    double least = std::numeric_limits<double>::infinity();
    constexpr int kCount = 5000;
    for (int k = 0; k <= kCount; ++k) {
      const double s = low + (high - low) * k / kCount;
      least = std::min(least, (p - path.at(s).pose.position()).norm());
    }
    ASSERT_LE(found.distance, least + 1e-12) << i;
    ASSERT_GE(found.distance, least - (high - low) / kCount) << i;
    ASSERT_GE(found.s, low);
    ASSERT_LE(found.s, high);
    const PathSample foot = path.at(found.s);
    const Point2 offset = p - foot.pose.position();
    ASSERT_NEAR(offset.norm(), found.distance, 1e-9) << i;
    // At a border between pieces that bend differently the other piece's heading is the same.
    ASSERT_NEAR(offset.dot(foot.pose.left()), found.lateral_error, 1e-6) << i;
  }
}

TEST(PathOfClothoids, ProjectsAPointBesideItBackToWhereItCameFrom) {
  RandomStream random(4, "clothoid path");
  for (int i = 0; i < 500; ++i) {
    Path path;
    path.append(random_piece(random, test::random_pose(random, 10.0), 0));
    if (path.pieces().front().sharpness == 0.0) continue;
    const double s = random.uniform(0.0, path.length());
    const double lateral = random.uniform(-0.5, 0.5);
    const PathSample foot = path.at(s);
    const Point2 p = foot.pose * Point2(0.0, lateral);
    const Projection found = path.project(p, s - 1.0, s + 1.0);
    ASSERT_NEAR(found.s, s, 1e-9);
    ASSERT_NEAR(found.lateral_error, lateral, 1e-9);
    ASSERT_NEAR(found.distance, std::abs(lateral), 1e-9);
  }
}

TEST(PathOfClothoids, ATurnedPieceRunsOverTheSameGroundTheOtherWay) {
  RandomStream random(5, "clothoid path");
  for (int i = 0; i < 100; ++i) {
    const PathPiece piece = random_piece(random, test::random_pose(random, 10.0), 3);
    const PathPiece back = turned_round(piece);
    EXPECT_EQ(back.gear, piece.gear);
    EXPECT_EQ(back.leg, 3);
    for (const double share : {0.0, 0.3, 0.7, 1.0}) {
      const double driven = share * piece.length;
      const Pose2 there = reversed(piece.pose_at(driven));
      const Pose2 here = back.pose_at(piece.length - driven);
      ASSERT_LT((there.position() - here.position()).norm(), 1e-11);
      ASSERT_NEAR(wrap_angle(there.yaw - here.yaw), 0.0, 1e-11);
      ASSERT_NEAR(back.curvature_at(piece.length - driven), -piece.curvature_at(driven), 1e-12);
    }
  }
}

TEST(PathOfClothoids, TakesAFittedClothoid) {
  const Pose2 from{1.0, 2.0, 0.3};
  const Pose2 to{30.0, 12.0, -0.4};
  Path path;
  path.append(fit_clothoid(from, to).value().curve, 5);
  EXPECT_LT((path.end_pose().position() - to.position()).norm(), 1e-10);
  EXPECT_EQ(path.at(3.0).leg, 5);
  EXPECT_EQ(path.segments().size(), 1U);
}

TEST(Path, ASliceIsAStretchOfIt) {
  Path path;
  path.append_straight({0.0, 0.0, 0.3}, 5.0, 0);
  Curve arc;
  arc.add({0.2, 4.0});
  arc.add({-0.1, -2.0});
  path.append(arc, path.end_pose(), 1);
  path.append({path.end_pose(), 0.1, 3.0, Gear::kForward, 2, -0.05});
  for (const auto& [from, to] : {std::pair(0.0, 14.0), {3.0, 7.5}, {8.0, 10.0}, {10.5, 13.0}}) {
    const Path part = path.slice(from, to);
    ASSERT_NEAR(part.length(), to - from, 1e-12);
    for (double s = 0.05; s < to - from; s += 0.1) {
      const PathSample a = part.at(s);
      const PathSample b = path.at(from + s);
      EXPECT_NEAR((a.pose.position() - b.pose.position()).norm(), 0.0, 1e-9) << from + s;
      EXPECT_NEAR(wrap_angle(a.pose.yaw - b.pose.yaw), 0.0, 1e-9) << from + s;
      EXPECT_NEAR(a.curvature, b.curvature, 1e-12) << from + s;
      EXPECT_EQ(a.leg, b.leg) << from + s;
      EXPECT_EQ(a.gear, b.gear) << from + s;
    }
  }
  EXPECT_TRUE(path.slice(5.0, 5.0).empty());
  EXPECT_EQ(path.slice(-1.0, 99.0).length(), path.length());
}

}  // namespace
}  // namespace headland
