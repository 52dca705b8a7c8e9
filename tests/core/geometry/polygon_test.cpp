// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/polygon.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

using ::testing::HasSubstr;

Polygon rectangle(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

double total_area(const std::vector<Polygon>& list) {
  double sum = 0.0;
  for (const Polygon& p : list) sum += area(p);
  return sum;
}

TEST(Polygon, AreaTakesHolesOutWhateverTheirDirection) {
  Polygon p = rectangle(0, 0, 10, 5);
  EXPECT_DOUBLE_EQ(area(p), 50.0);
  p.holes.push_back({{1, 1}, {2, 1}, {2, 2}, {1, 2}});
  EXPECT_DOUBLE_EQ(area(p), 49.0);
  std::reverse(p.outer.begin(), p.outer.end());
  EXPECT_DOUBLE_EQ(area(p), 49.0);
}

TEST(Polygon, AreaKeepsItsDigitsFarFromTheOrigin) {
  EXPECT_NEAR(area(rectangle(5e6, 4e6, 5e6 + 0.5, 4e6 + 0.5)), 0.25, 1e-12);
}

TEST(Polygon, ContainsPointsInsideButNotInHoles) {
  Polygon p = rectangle(0, 0, 10, 10);
  p.holes.push_back({{4, 4}, {6, 4}, {6, 6}, {4, 6}});
  EXPECT_TRUE(contains(p, {1, 5}));
  EXPECT_FALSE(contains(p, {5, 5}));
  EXPECT_FALSE(contains(p, {11, 5}));
  EXPECT_FALSE(contains(p, {-1, 4}));
  EXPECT_FALSE(contains(Polygon{}, {0, 0}));
}

TEST(Polygon, CheckedOrientsRingsAndDropsRepeatedPoints) {
  Polygon p{{{0, 0}, {0, 10}, {0, 10}, {10, 10}, {10, 0}, {0, 0}},
            {{{1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}}}};
  const auto clean = checked(p);
  ASSERT_TRUE(clean) << to_string(clean.error());
  ASSERT_EQ(clean->outer.size(), 4u);
  ASSERT_EQ(clean->holes.size(), 1u);
  ASSERT_EQ(clean->holes[0].size(), 4u);
  // Inside lies to the left of every outer edge and, of holes, outside does: the turn at a convex
  // corner tells.
  const auto turn = [](const Polyline& r) {
    const Point2 a = r[1] - r[0];
    const Point2 b = r[2] - r[1];
    return a.x() * b.y() - a.y() * b.x();
  };
  EXPECT_GT(turn(clean->outer), 0.0);
  EXPECT_LT(turn(clean->holes[0]), 0.0);
}

TEST(Polygon, CheckedNamesThePlaceOfACrossing) {
  const auto bow_tie = checked({{{0, 0}, {10, 10}, {10, 0}, {0, 10}}, {}});
  ASSERT_FALSE(bow_tie);
  EXPECT_EQ(bow_tie.error().code, ErrorCode::kBadGeometry);
  EXPECT_THAT(bow_tie.error().what, HasSubstr("crosses"));
  EXPECT_THAT(bow_tie.error().what, HasSubstr("(5.000, 5.000)"));
}

TEST(Polygon, CheckedRefusesRingsWithoutArea) {
  for (const Polyline& ring : {Polyline{},
                               {{1, 1}},
                               {{0, 0}, {1, 1}},
                               {{0, 0}, {1, 1}, {2, 2}},
                               {{3, 3}, {3, 3}, {3, 3}},
                               {{0, 0}, {1, 0}, {0, std::nan("")}}}) {
    const auto result = checked({ring, {}});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::kBadGeometry);
  }
}

TEST(Polygon, CheckedRefusesAHoleOutside) {
  Polygon p = rectangle(0, 0, 10, 10);
  p.holes.push_back({{20, 20}, {21, 20}, {21, 21}});
  EXPECT_FALSE(checked(p));
}

TEST(Polygon, SetOperationsObeyTheLawsOfAreas) {
  RandomStream random(7, "polygon");
  for (int i = 0; i < 50; ++i) {
    const auto box = [&] {
      const double x = random.uniform(0, 10);
      const double y = random.uniform(0, 10);
      return rectangle(x, y, x + random.uniform(1, 8), y + random.uniform(1, 8));
    };
    const std::vector<Polygon> a = unite({box(), box()});
    const std::vector<Polygon> b = unite({box(), box(), box()});
    std::vector<Polygon> both = a;
    both.insert(both.end(), b.begin(), b.end());
    const double common = total_area(intersect(a, b));
    EXPECT_NEAR(total_area(unite(both)), total_area(a) + total_area(b) - common, 1e-9);
    EXPECT_NEAR(total_area(subtract(a, b)), total_area(a) - common, 1e-9);
  }
}

TEST(Polygon, ASubtractedMiddleLeavesAHole) {
  const auto ring = subtract({rectangle(0, 0, 10, 10)}, {rectangle(4, 4, 6, 6)});
  ASSERT_EQ(ring.size(), 1u);
  ASSERT_EQ(ring[0].holes.size(), 1u);
  EXPECT_DOUBLE_EQ(area(ring[0]), 96.0);
  EXPECT_TRUE(subtract({rectangle(0, 0, 1, 1)}, {rectangle(-1, -1, 2, 2)}).empty());
  EXPECT_TRUE(unite({}).empty());
}

TEST(Polygon, GrowRoundsCornersAndShrinkUndoesIt) {
  const auto grown = grow({rectangle(0, 0, 10, 5)}, 2.0);
  ASSERT_EQ(grown.size(), 1u);
  // Steiner: A + P r + pi r^2; the 64 chords lose under 0.2 % of the disc.
  EXPECT_NEAR(area(grown[0]), 50 + 30 * 2 + kPi * 4, 0.025);
  EXPECT_NEAR(total_area(grow(grown, -2.0)), 50.0, 0.05);
  EXPECT_TRUE(grow({rectangle(0, 0, 10, 5)}, -3.0).empty());
}

TEST(Polygon, WidenIsFlatAtTheEnds) {
  const auto strip = widen({{0, 0}, {10, 0}}, 4.0);
  ASSERT_EQ(strip.size(), 1u);
  EXPECT_NEAR(area(strip[0]), 40.0, 1e-9);
  EXPECT_TRUE(widen({{0, 0}}, 4.0).empty());
}

TEST(Polygon, DistancesAndLengths) {
  EXPECT_DOUBLE_EQ(length({{0, 0}, {3, 4}, {3, 5}}), 6.0);
  EXPECT_DOUBLE_EQ(length({}), 0.0);
  EXPECT_DOUBLE_EQ(distance_to_segment({5, 2}, {0, 0}, {10, 0}), 2.0);
  EXPECT_DOUBLE_EQ(distance_to_segment({13, 4}, {0, 0}, {10, 0}), 5.0);
  EXPECT_DOUBLE_EQ(distance_to_segment({3, 4}, {0, 0}, {0, 0}), 5.0);
}

}  // namespace
}  // namespace headland
