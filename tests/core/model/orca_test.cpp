// SPDX-License-Identifier: Apache-2.0
#include "core/model/orca.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

double violation(const VelocityLine& line, const Point2& v) {
  const Point2 d = line.point - v;
  return line.direction.x() * d.y() - line.direction.y() * d.x();
}

double worst_violation(std::span<const VelocityLine> lines, const Point2& v) {
  double worst = -std::numeric_limits<double>::infinity();
  for (const VelocityLine& line : lines) worst = std::max(worst, violation(line, v));
  return worst;
}

Point2 random_point(RandomStream& random, double half_side) {
  return {random.uniform(-half_side, half_side), random.uniform(-half_side, half_side)};
}

std::vector<VelocityLine> random_lines(RandomStream& random, int count, double half_side) {
  std::vector<VelocityLine> lines;
  for (int i = 0; i < count; ++i) {
    const double angle = random.uniform(0.0, 6.283185307179586);
    lines.push_back({random_point(random, half_side), {std::cos(angle), std::sin(angle)}});
  }
  return lines;
}

/// The least distance between discs' centres if the relative velocity is held for `horizon`.
double closest(const Point2& offset, const Point2& relative, double horizon) {
  const double speed2 = relative.squaredNorm();
  const double t = speed2 > 0.0 ? std::clamp(offset.dot(relative) / speed2, 0.0, horizon) : 0.0;
  return (offset - t * relative).norm();
}

// ---- The line of a pair

TEST(Orca, ApplyingTheWholeOfUBringsARelativeVelocityToTheBorderOfTheVelocityObstacle) {
  RandomStream random(1, "orca_line");
  for (int i = 0; i < 5000; ++i) {
    const Point2 offset = random_point(random, 6.0);
    const OrcaNeighbor other{offset, random_point(random, 2.0), 1.0, 1.0};
    if (offset.norm() <= other.reach_m + 1e-3) continue;
    const Point2 velocity = random_point(random, 2.0);
    const VelocityLine line = orca_line({0.0, 0.0}, velocity, other, 4.0, 0.1);
    const Point2 relative = line.point - other.velocity;
    ASSERT_NEAR(line.direction.norm(), 1.0, 1e-12);
    ASSERT_NEAR(closest(offset, relative, 4.0), 1.0, 1e-6) << "case " << i;
    // Left of the line is out of the obstacle.
    const Point2 out(-line.direction.y(), line.direction.x());
    ASSERT_GT(closest(offset, relative + 0.05 * out, 4.0), 1.0) << "case " << i;
  }
}

TEST(Orca, NoSmallerChangeLeavesTheVelocityObstacle) {
  RandomStream random(2, "orca_line");
  for (int i = 0; i < 300; ++i) {
    const OrcaNeighbor other{random_point(random, 5.0), random_point(random, 1.0), 1.2, 1.0};
    const Point2 velocity = random_point(random, 1.5);
    if (other.position.norm() < 1.3) continue;
    const Point2 relative = velocity - other.velocity;
    const bool inside = closest(other.position, relative, 3.0) < 1.2;
    const VelocityLine line = orca_line({0.0, 0.0}, velocity, other, 3.0, 0.1);
    const double change = (line.point - velocity).norm();
    for (int k = 0; k < 200; ++k) {
      const double angle = 6.283185307179586 * k / 200.0;
      const Point2 moved = relative + 0.98 * change * Point2(std::cos(angle), std::sin(angle));
      ASSERT_EQ(closest(other.position, moved, 3.0) < 1.2, inside) << "case " << i;
    }
  }
}

TEST(Orca, TheShareIsThePartOfTheChangeThatTheAgentTakesOn) {
  const Point2 velocity(1.0, 0.1);
  OrcaNeighbor other{{4.0, 0.0}, {-1.0, 0.0}, 1.0, 1.0};
  const VelocityLine all = orca_line({0.0, 0.0}, velocity, other, 5.0, 0.1);
  other.share = 0.25;
  const VelocityLine quarter = orca_line({0.0, 0.0}, velocity, other, 5.0, 0.1);
  other.share = 0.0;
  const VelocityLine none = orca_line({0.0, 0.0}, velocity, other, 5.0, 0.1);
  EXPECT_LT((quarter.point - (velocity + 0.25 * (all.point - velocity))).norm(), 1e-12);
  EXPECT_EQ(none.point, velocity);
  EXPECT_EQ(none.direction, all.direction);
}

TEST(Orca, OverlappingAgentsAreApartAfterOneStep) {
  RandomStream random(3, "orca_overlap");
  for (int i = 0; i < 1000; ++i) {
    const OrcaNeighbor other{random_point(random, 0.7), random_point(random, 1.0), 1.0, 1.0};
    if (other.position.norm() > 1.0) continue;
    const VelocityLine line = orca_line({0.0, 0.0}, random_point(random, 1.0), other, 5.0, 0.25);
    const Point2 after = other.position + 0.25 * (other.velocity - line.point);
    ASSERT_NEAR(after.norm(), 1.0, 1e-9) << "case " << i;
  }
}

TEST(Orca, AgentsAtTheSamePlaceWithTheSameVelocityGetALineThatIsANumber) {
  for (const double reach : {0.0, 1.0}) {
    const VelocityLine line =
        orca_line({3.0, 4.0}, {1.0, 0.0}, {{3.0, 4.0}, {1.0, 0.0}, reach, 0.5}, 5.0, 0.1);
    EXPECT_TRUE(line.point.allFinite());
    EXPECT_NEAR(line.direction.norm(), 1.0, 1e-12);
  }
}

// Two agents that walk towards each other's place; one with a share of 0 does not see the other.
double closest_approach(Point2 a, Point2 b, double share_a, double share_b, double* seconds) {
  const double step = 0.1;
  const Point2 goal_a = b;
  const Point2 goal_b = a;
  Point2 va(0.0, 0.0);
  Point2 vb(0.0, 0.0);
  std::vector<VelocityLine> scratch;
  double least = (a - b).norm();
  *seconds = 0.0;
  while (*seconds < 60.0 && ((a - goal_a).norm() > 0.2 || (b - goal_b).norm() > 0.2)) {
    const VelocityLine la = orca_line(a, va, {b, vb, 1.0, share_a}, 5.0, step);
    const VelocityLine lb = orca_line(b, vb, {a, va, 1.0, share_b}, 5.0, step);
    const std::size_t count_b = share_b > 0.0 ? 1 : 0;
    const auto to = [](const Point2& from, const Point2& goal) {
      return Point2((goal - from) / std::max(1.0, (goal - from).norm()));
    };
    va = permitted_velocity({&la, 1}, 0, to(a, goal_a), 1.5, scratch);
    vb = permitted_velocity({&lb, count_b}, 0, to(b, goal_b), 1.5, scratch);
    a += step * va;
    b += step * vb;
    least = std::min(least, (a - b).norm());
    *seconds += step;
  }
  return least;
}

TEST(Orca, HeadOnPairPassesWithoutTouching) {
  double seconds = 0.0;
  EXPECT_GT(closest_approach({-8.0, 0.0}, {8.0, 0.01}, 0.5, 0.5, &seconds), 1.0 - 1e-3);
  EXPECT_LT(seconds, 20.0);
}

TEST(Orca, AnExactlySymmetricPairStandsFaceToFaceButDoesNotTouch) {
  double seconds = 0.0;
  EXPECT_GT(closest_approach({-8.0, 0.0}, {8.0, 0.0}, 0.5, 0.5, &seconds), 1.0 - 1e-3);
}

TEST(Orca, OneAgentThatTakesAllOfItPassesOneThatTakesNothing) {
  double seconds = 0.0;
  EXPECT_GT(closest_approach({-8.0, 0.0}, {8.0, 0.05}, 1.0, 0.0, &seconds), 1.0 - 1e-3);
  EXPECT_LT(seconds, 20.0);
}

// ---- The linear programs

TEST(Orca, WithoutLinesThePreferredVelocityIsCutToTheTopSpeed) {
  std::vector<VelocityLine> scratch;
  EXPECT_EQ(permitted_velocity({}, 0, {0.3, 0.4}, 1.0, scratch), Point2(0.3, 0.4));
  EXPECT_LT((permitted_velocity({}, 0, {3.0, 4.0}, 1.0, scratch) - Point2(0.6, 0.8)).norm(), 1e-12);
  EXPECT_EQ(permitted_velocity({}, 0, {3.0, 4.0}, 0.0, scratch), Point2(0.0, 0.0));
}

TEST(Orca, NoSampleIsNearerToThePreferredVelocityOrLessInViolation) {
  RandomStream random(4, "linear_programs");
  int feasible = 0;
  int infeasible = 0;
  std::vector<VelocityLine> scratch;
  for (int i = 0; i < 400; ++i) {
    const auto lines = random_lines(random, 1 + random.index(10), 1.2);
    const Point2 preferred = random_point(random, 2.0);
    const Point2 best = permitted_velocity(lines, 0, preferred, 1.5, scratch);
    ASSERT_LE(best.norm(), 1.5 + 1e-9);
    const double worst = worst_violation(lines, best);
    (worst <= 1e-9 ? feasible : infeasible) += 1;
    for (int k = 0; k < 2000; ++k) {
      const Point2 v = random_point(random, 1.5);
      if (v.norm() > 1.5) continue;
      const double sample = worst_violation(lines, v);
      if (worst > 1e-9) {
        ASSERT_GE(sample, worst - 1e-9) << "case " << i;
      } else if (sample <= 0.0) {
        ASSERT_GE((v - preferred).norm(), (best - preferred).norm() - 1e-9) << "case " << i;
      }
    }
  }
  EXPECT_GT(feasible, 100);
  EXPECT_GT(infeasible, 100);
}

TEST(Orca, HardLinesHoldWhereTheOthersCannot) {
  RandomStream random(5, "hard_lines");
  int fallbacks = 0;
  std::vector<VelocityLine> scratch;
  for (int i = 0; i < 400; ++i) {
    auto lines = random_lines(random, 8, 1.0);
    for (std::size_t k = 0; k < 3; ++k) {  // to stand still breaks no hard line
      const Point2 out(lines[k].direction.y(), -lines[k].direction.x());
      lines[k].point = random.uniform(0.0, 0.5) * out;
    }
    const Point2 best = permitted_velocity(lines, 3, random_point(random, 1.5), 1.5, scratch);
    const std::span<const VelocityLine> all(lines);
    ASSERT_LE(worst_violation(all.first(3), best), 1e-9);
    const double worst = worst_violation(all.subspan(3), best);
    if (worst <= 1e-9) continue;
    ++fallbacks;
    for (int k = 0; k < 2000; ++k) {
      const Point2 v = random_point(random, 1.5);
      if (v.norm() > 1.5 || worst_violation(all.first(3), v) > 0.0) continue;
      ASSERT_GE(worst_violation(all.subspan(3), v), worst - 1e-9) << "case " << i;
    }
  }
  EXPECT_GT(fallbacks, 50);
}

TEST(Orca, HardLinesThatContradictEachOtherAreViolatedAlike) {
  const std::vector<VelocityLine> lines = {{{0.5, 0.0}, {0.0, -1.0}},  // right of x = 0.5
                                           {{-0.3, 0.0}, {0.0, 1.0}},  // left of x = -0.3
                                           {{0.0, 5.0}, {1.0, 0.0}}};  // someone pushes
  std::vector<VelocityLine> scratch;
  const Point2 v = permitted_velocity(lines, 2, {1.0, 0.0}, 1.5, scratch);
  EXPECT_NEAR(v.x(), 0.1, 1e-9);
  EXPECT_LE(v.norm(), 1.5 + 1e-9);
}

// ---- Obstacles

const Polyline kSquare = {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}};

/// Distance [m] from p to the outline of a ring.
double distance_to_ring(const Polyline& ring, const Point2& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    least = std::min(least, distance_to_segment(p, ring[i], ring[(i + 1) % ring.size()]));
  }
  return least;
}

/// Walks from `start` to `goal`; the least distance to the ring on the way, and where it ends.
double least_clearance(const Polyline& ring, Point2 start, const Point2& goal, Point2* end) {
  const OrcaObstacles obstacles({ring});
  Point2 velocity(0.0, 0.0);
  std::vector<VelocityLine> lines;
  std::vector<VelocityLine> scratch;
  double least = distance_to_ring(ring, start);
  for (int i = 0; i < 600; ++i) {
    lines.clear();
    obstacles.append_lines(start, velocity, 0.5, 3.0, 1.5, lines);
    const Point2 wish = (goal - start) / std::max(1.0, (goal - start).norm());
    velocity = permitted_velocity(lines, lines.size(), wish, 1.5, scratch);
    start += 0.1 * velocity;
    least = std::min(least, distance_to_ring(ring, start));
  }
  *end = start;
  return least;
}

TEST(OrcaObstacles, AnAgentWalksAroundACornerAndKeepsItsRadiusFromIt) {
  Point2 end;
  EXPECT_GT(least_clearance(kSquare, {-4.0, 0.4}, {4.0, 3.0}, &end), 0.5 - 1e-6);
  EXPECT_LT((end - Point2(4.0, 3.0)).norm(), 0.1);
}

TEST(OrcaObstacles, AnAgentComesToRestAtAWallInItsWay) {
  const Polyline wall = {{2.0, -50.0}, {2.0, 50.0}};
  for (const double side : {1.0, -1.0}) {
    Point2 end;
    const Point2 start(2.0 - 4.0 * side, 0.0);
    EXPECT_GT(least_clearance(wall, start, {2.0 + 4.0 * side, 0.0}, &end), 0.5 - 1e-6);
    EXPECT_NEAR(end.x(), 2.0 - 0.5 * side, 0.02);
  }
}

TEST(OrcaObstacles, AFenceKeepsAnAgentInItsCorner) {
  Polyline fence = {{-5.0, -5.0}, {5.0, -5.0}, {5.0, 5.0}, {-5.0, 5.0}};
  std::reverse(fence.begin(), fence.end());
  Point2 end;
  EXPECT_GT(least_clearance(fence, {0.0, 1.0}, {9.0, 8.0}, &end), 0.5 - 1e-6);
  EXPECT_LT((end - Point2(4.5, 4.5)).norm(), 0.05);
}

TEST(OrcaObstacles, AnObstacleThatIsNotConvexIsKeptAwayFromAsWell) {
  const Polyline hook = {{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {3.0, 4.0}, {3.0, 1.0}, {0.0, 1.0}};
  Point2 end;
  EXPECT_GT(least_clearance(hook, {0.0, 3.0}, {6.0, 0.5}, &end), 0.5 - 1e-6);
}

TEST(OrcaObstacles, StandingStillIsPermittedWhereverAnAgentStands) {
  RandomStream random(6, "obstacles");
  const Polyline star = {{0.0, 3.0},  {-0.7, 1.0}, {-2.9, 0.9}, {-1.1, -0.4}, {-1.8, -2.4},
                         {0.0, -1.2}, {1.8, -2.4}, {1.1, -0.4}, {2.9, 0.9},   {0.7, 1.0}};
  const OrcaObstacles obstacles({star, {{4.0, -4.0}, {5.0, 4.0}}});
  std::vector<VelocityLine> lines;
  std::size_t seen = 0;
  for (int i = 0; i < 20000; ++i) {
    lines.clear();
    obstacles.append_lines(random_point(random, 6.0), random_point(random, 1.5), 0.4, 3.0, 1.5,
                           lines);
    seen += lines.size();
    ASSERT_LE(worst_violation(lines, {0.0, 0.0}), 1e-9) << "case " << i;
  }
  EXPECT_GT(seen, 20000u);
}

TEST(OrcaObstacles, APermittedVelocityOfOneConvexObstacleLeadsNowhereNearItWithinTheHorizon) {
  RandomStream random(7, "obstacles");
  const OrcaObstacles obstacles({kSquare});
  std::vector<VelocityLine> lines;
  for (int i = 0; i < 3000; ++i) {
    const Point2 position = random_point(random, 5.0);
    if (position.cwiseAbs().maxCoeff() < 1.0 || distance_to_ring(kSquare, position) < 0.5) continue;
    lines.clear();
    obstacles.append_lines(position, random_point(random, 1.5), 0.5, 3.0, 1.5, lines);
    const Point2 v = random_point(random, 1.0);
    if (!lines.empty() && worst_violation(lines, v) > 0.0) continue;
    for (int k = 0; k <= 60; ++k) {
      ASSERT_GE(distance_to_ring(kSquare, position + 0.05 * k * v), 0.5 - 1e-6) << "case " << i;
    }
  }
}

TEST(OrcaObstacles, RingsOfOnePointAndPointsThatAreNoNumbersAreLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(OrcaObstacles({{{1.0, 1.0}, {1.0, 1.0}}, {}, {{nan, 0.0}, {2.0, 2.0}}}).empty());
  const OrcaObstacles wall({{{0.0, 0.0}, {nan, 1.0}, {2.0, 0.0}, {2.0, 0.0}}});
  std::vector<VelocityLine> lines;
  wall.append_lines({1.0, 1.0}, {0.0, 0.0}, 0.3, 3.0, 1.0, lines);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].point.allFinite());
}

TEST(OrcaObstacles, ObstaclesOutOfReachAndBehindOthersAddNoLine) {
  const OrcaObstacles obstacles({kSquare, {{-1.0, 1.5}, {-1.0, 1.2}, {1.0, 1.2}, {1.0, 1.5}}});
  std::vector<VelocityLine> lines;
  obstacles.append_lines({0.0, -3.0}, {0.0, 0.0}, 0.5, 2.0, 1.0, lines);
  EXPECT_EQ(lines.size(), 1u);
  lines.clear();
  obstacles.append_lines({0.0, -30.0}, {0.0, 0.0}, 0.5, 2.0, 1.0, lines);
  EXPECT_TRUE(lines.empty());
}

}  // namespace
}  // namespace headland
