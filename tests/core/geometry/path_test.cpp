// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/path.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "core/geometry/fishtail.hpp"
#include "core/geometry/reeds_shepp.hpp"
#include "tests/support/steering_curves.hpp"

namespace headland {
namespace {

// A row northward, a fishtail to the right, the next row back: legs 0, 1, 2.
Path row_fishtail_row() {
  Path path;
  path.append_straight({0.0, 0.0, 0.5 * kPi}, 20.0, 0);
  const Pose2 next_row{2.5, 20.0, -0.5 * kPi};
  path.append(fishtail(path.end_pose(), next_row, 3.0).value(), path.end_pose(), 1);
  path.append_straight(next_row, 20.0, 2);
  return path;
}

// Reeds-Shepp curves through random poses; has both gears.
Path random_path(RandomStream& random, int legs) {
  Path path;
  Pose2 here = test::random_pose(random, 10.0);
  for (int leg = 0; leg < legs; ++leg) {
    const Pose2 there = test::random_pose(random, 10.0);
    path.append(shortest_reeds_shepp(here, there, 2.0), here, leg);
    here = path.end_pose();
  }
  return path;
}

TEST(Path, IsAsLongAsItsPiecesAndEndsWhereTheyEnd) {
  const Path path = row_fishtail_row();
  EXPECT_NEAR(path.length(), 40.0 + (kPi + 2.0) * 3.0 - 2.5, 1e-12);
  EXPECT_EQ(path.pieces().size(), 5U);
  EXPECT_NEAR(path.end_pose().x, 2.5, 1e-9);
  EXPECT_NEAR(path.end_pose().y, 0.0, 1e-9);
  EXPECT_TRUE(Path().empty());
  EXPECT_EQ(Path().length(), 0.0);
}

TEST(Path, HasASegmentForEachStretchOfOneGear) {
  const Path path = row_fishtail_row();
  const auto& segments = path.segments();
  ASSERT_EQ(segments.size(), 3U);
  EXPECT_EQ(segments[0].gear, Gear::kForward);
  EXPECT_EQ(segments[1].gear, Gear::kReverse);
  EXPECT_EQ(segments[2].gear, Gear::kForward);
  EXPECT_EQ(segments[0].begin_s, 0.0);
  EXPECT_EQ(segments[0].end_s, segments[1].begin_s);
  EXPECT_EQ(segments[1].end_s, segments[2].begin_s);
  EXPECT_EQ(segments[2].end_s, path.length());
  EXPECT_NEAR(segments[1].end_s - segments[1].begin_s, 3.5, 1e-12);
}

TEST(Path, AtAJointTheLaterPieceCountsAndOutsideThePathItsEnds) {
  const Path path = row_fishtail_row();
  EXPECT_EQ(path.at(20.0).leg, 1);
  EXPECT_EQ(path.at(20.0 - 1e-9).leg, 0);
  const double cusp = path.segments()[0].end_s;
  EXPECT_EQ(path.at(cusp).segment, 1);
  EXPECT_EQ(path.at(cusp).gear, Gear::kReverse);
  EXPECT_EQ(path.at(cusp - 1e-9).segment, 0);
  EXPECT_EQ(path.at(-5.0).s, 0.0);
  EXPECT_EQ(path.at(1e9).s, path.length());
  EXPECT_EQ(path.at(1e9).segment, 2);
  EXPECT_EQ(path.at(1e9).leg, 2);
}

TEST(Path, SamplesAgreeWithDrivingThePathInSmallSteps) {
  RandomStream random(1, "path");
  const Path path = random_path(random, 10);
  const double step = 1e-3;
  for (double s = 0.0; s + step < path.length(); s += step) {
    const PathSample here = path.at(s);
    const PathSample next = path.at(s + step);
    if (here.segment != next.segment || here.curvature != next.curvature) continue;
    const Pose2 driven = advance(here.pose, here.curvature, sign(here.gear) * step);
    ASSERT_LT((driven.position() - next.pose.position()).norm(), 1e-11) << s;
    ASSERT_LT(std::abs(wrap_angle(driven.yaw - next.pose.yaw)), 1e-11) << s;
    ASSERT_EQ(path.segments()[static_cast<std::size_t>(here.segment)].gear, here.gear);
  }
}

TEST(Path, SamplesAreNoFurtherApartThanAskedAndHoldAllJoints) {
  RandomStream random(2, "path");
  const Path path = random_path(random, 10);
  for (const double spacing : {0.05, 0.3, 100.0}) {
    const std::vector<PathSample> samples = path.sample(spacing);
    EXPECT_EQ(samples.front().s, 0.0);
    EXPECT_EQ(samples.back().s, path.length());
    for (std::size_t i = 1; i < samples.size(); ++i) {
      ASSERT_GT(samples[i].s, samples[i - 1].s);
      ASSERT_LE(samples[i].s - samples[i - 1].s, spacing + 1e-9);
    }
    double joint = 0.0;
    for (const PathPiece& piece : path.pieces()) {
      joint += piece.length;
      const auto at_joint = [&](const PathSample& s) { return std::abs(s.s - joint) < 1e-9; };
      ASSERT_EQ(std::count_if(samples.begin(), samples.end(), at_joint), 1) << joint;
    }
  }
  EXPECT_TRUE(Path().sample(0.1).empty());
}

// Nearest of dense samples in the window, then halved steps around it.
Projection dense_projection(const Path& path, const Point2& p, double from_s, double to_s) {
  constexpr int kCount = 4000;
  Projection best;
  best.distance = std::numeric_limits<double>::infinity();
  const auto offer = [&](double s) {
    const Point2 offset = p - path.at(s).pose.position();
    if (offset.norm() < best.distance) {
      best = {s, offset.dot(path.at(s).pose.left()), offset.norm()};
    }
  };
  for (int i = 0; i <= kCount; ++i) offer(from_s + (to_s - from_s) * i / kCount);
  for (double step = (to_s - from_s) / kCount; step > 1e-10; step *= 0.5) {
    const double s = best.s;
    offer(std::max(from_s, s - step));
    offer(std::min(to_s, s + step));
  }
  return best;
}

TEST(Path, ProjectionsAgreeWithTheNearestOfDenseSamples) {
  RandomStream random(3, "path");
  for (int i = 0; i < 200; ++i) {
    const Path path = random_path(random, 1 + random.index(4));
    const Point2 p = test::random_pose(random, 12.0).position();
    const double a = random.uniform(0.0, path.length());
    const double b = i % 2 == 0 ? path.length() : random.uniform(0.0, path.length());
    const double low = i % 2 == 0 ? 0.0 : std::min(a, b);
    const double high = std::max(a, b);
    const Projection found = path.project(p, low, high);
    const Projection oracle = dense_projection(path, p, low, high);
    ASSERT_NEAR(found.distance, oracle.distance, 1e-6) << i;
    ASSERT_LE(found.distance, oracle.distance + 1e-12) << i;
    ASSERT_GE(found.s, low);
    ASSERT_LE(found.s, high);
    const PathSample foot = path.at(found.s);
    ASSERT_NEAR((p - foot.pose.position()).norm(), found.distance, 1e-9) << i;
    if (std::abs(found.s - oracle.s) < 1e-3) {  // else two points are equally near
      ASSERT_NEAR(found.lateral_error, oracle.lateral_error, 1e-3) << i;
    }
  }
}

TEST(Path, LateralErrorIsPositiveToTheLeftOfTheHeadingInBothGears) {
  Curve curve;
  curve.add({0.0, 10.0});
  curve.add({0.0, -4.0});
  curve.add({0.25, -3.0});
  Path path;
  path.append(curve, {}, 0);
  EXPECT_NEAR(path.project({5.0, 0.3}, 0.0, 10.0).lateral_error, 0.3, 1e-12);
  EXPECT_NEAR(path.project({5.0, -0.3}, 0.0, 10.0).lateral_error, -0.3, 1e-12);
  const Projection back = path.project({8.0, 0.3}, 10.0, 14.0);
  EXPECT_NEAR(back.s, 12.0, 1e-12);
  EXPECT_NEAR(back.lateral_error, 0.3, 1e-12) << "the vehicle still heads east";
  for (const double driven : {0.5, 1.5, 2.5}) {
    const PathSample on_arc = path.at(14.0 + driven);
    for (const double error : {0.4, -0.4}) {
      const Point2 p = on_arc.pose.position() + error * on_arc.pose.left();
      const Projection found = path.project(p, 10.0, path.length());
      EXPECT_NEAR(found.s, 14.0 + driven, 1e-9);
      EXPECT_NEAR(found.lateral_error, error, 1e-9);
      EXPECT_NEAR(found.distance, 0.4, 1e-9);
    }
  }
}

TEST(Path, ProjectionLooksAtItsWindowOnly) {
  const Path path = row_fishtail_row();
  const Point2 on_first_row{0.0, 10.0};
  EXPECT_NEAR(path.project(on_first_row, 0.0, path.length()).s, 10.0, 1e-12);
  EXPECT_EQ(path.project(on_first_row, 0.0, 4.0).s, 4.0);
  EXPECT_EQ(path.project(on_first_row, 12.0, 15.0).s, 12.0);
  EXPECT_NEAR(path.project(on_first_row, 12.0, 15.0).distance, 2.0, 1e-12);
  const Projection second = path.project(on_first_row, path.length() - 20.0, path.length());
  EXPECT_NEAR(second.s, path.length() - 10.0, 1e-9);
  EXPECT_NEAR(second.lateral_error, -2.5, 1e-9) << "seen heading south the west is to the right";
  EXPECT_EQ(path.project(on_first_row, 7.0, 7.0).s, 7.0);
}

TEST(Path, ProjectsOnArcsBeyondHalfATurnAndFromTheirCentre) {
  Path path;
  path.append(PathPiece{{}, 0.5, 1.5 * kPi * 2.0, Gear::kForward, 0});
  const Point2 west_of_the_centre{-1.0, 2.0};
  EXPECT_NEAR(path.project(west_of_the_centre, 0.0, path.length()).s, path.length(), 1e-9);
  EXPECT_NEAR(path.project({0.0, 2.0}, 0.0, path.length()).distance, 2.0, 1e-12);
  EXPECT_NEAR(path.project({0.0, 5.0}, 0.0, path.length()).s, kPi * 2.0, 1e-12);
}

TEST(Path, KnowsWhereItsLegsBeginAndEnd) {
  const Path path = row_fishtail_row();
  EXPECT_EQ(path.leg_range(0), std::pair(0.0, 20.0));
  EXPECT_EQ(path.leg_range(1).first, 20.0);
  EXPECT_EQ(path.leg_range(1).second, path.leg_range(2).first);
  EXPECT_EQ(path.leg_range(2).second, path.length());
  EXPECT_EQ(path.leg_range(7), std::pair(0.0, 0.0));
}

TEST(Path, AppendsAnotherPathRaisingItsLegs) {
  Path path = row_fishtail_row();
  Path more;
  more.append_straight(path.end_pose(), 5.0, 0);
  more.append_straight(more.end_pose(), 0.0, 1);
  EXPECT_EQ(more.pieces().size(), 1U) << "a straight of no length is none";
  const double before = path.length();
  path.append(more, 3);
  EXPECT_EQ(path.length(), before + 5.0);
  EXPECT_EQ(path.leg_range(3), std::pair(before, before + 5.0));
  EXPECT_EQ(path.segments().size(), 3U) << "the same gear goes on";
}

TEST(Path, AClosedPathMayBeAppendedToItself) {
  Path circle;
  circle.append(PathPiece{{}, 0.5, 2.0 * kPi * 2.0, Gear::kForward, 0});
  circle.append(circle, 1);
  EXPECT_NEAR(circle.length(), 8.0 * kPi, 1e-12);
  EXPECT_EQ(circle.pieces().size(), 2U);
}

TEST(PathDeathTest, APieceThatDoesNotStartAtTheEndIsRefused) {
  Path path;
  path.append_straight({}, 10.0, 0);
  EXPECT_DEATH(path.append_straight({10.0, 2e-6, 0.0}, 1.0, 0), "does not start");
  EXPECT_DEATH(path.append_straight({10.0, 0.0, 2e-6}, 1.0, 0), "does not start");
  EXPECT_DEATH(path.append(PathPiece{{10.0, 0.0, 0.0}, 0.0, 0.0, Gear::kForward, 0}), "no length");
  path.append_straight({10.0, 5e-7, 2.0 * kPi}, 1.0, 0);
  EXPECT_NEAR(path.length(), 11.0, 1e-12);
}

TEST(PathDeathTest, AnEmptyPathHasNoPoses) {
  EXPECT_DEATH(static_cast<void>(Path().start_pose()), "empty");
  EXPECT_DEATH(static_cast<void>(Path().at(0.0)), "empty");
}

}  // namespace
}  // namespace headland
