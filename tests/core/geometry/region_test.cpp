// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/region.hpp"

#include <chrono>

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

Polygon rectangle(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

// A ring around `center` whose radius wanders between the two given: usually not convex.
Polygon star(RandomStream& random, Point2 center, double near, double far, int points) {
  Polygon p;
  for (int i = 0; i < points; ++i) {
    const double angle = 2.0 * kPi * i / points;
    p.outer.push_back(center +
                      random.uniform(near, far) * Point2(std::cos(angle), std::sin(angle)));
  }
  return p;
}

// A wide star with several smaller ones cut out, some of them through its border.
std::vector<Polygon> random_area(RandomStream& random, int points) {
  std::vector<Polygon> holes;
  for (int i = 0; i < 6; ++i) {
    const Point2 center(random.uniform(-40, 40), random.uniform(-40, 40));
    holes.push_back(star(random, center, 1.0, 6.0, 3 + random.index(20)));
  }
  return subtract({star(random, {0, 0}, 25.0, 50.0, points)}, holes);
}

Polygon outline(const Pose2& T_map_base, const Footprint& f, double margin) {
  const double half = 0.5 * f.width_m + margin;
  Polygon p;
  for (const Point2& corner :
       {Point2(-f.rear_m - margin, -half), Point2(f.front_m + margin, -half),
        Point2(f.front_m + margin, half), Point2(-f.rear_m - margin, half)}) {
    p.outer.push_back(T_map_base * corner);
  }
  return p;
}

// Oracle by set operations: what of the outline lies outside?
double area_outside(const Polygon& shape, const std::vector<Polygon>& area_list) {
  double sum = 0.0;
  for (const Polygon& p : subtract({shape}, area_list)) sum += area(p);
  return sum;
}

TEST(Region, PointContainmentAgreesWithThePolygons) {
  RandomStream random(1, "region points");
  for (int shape = 0; shape < 20; ++shape) {
    const auto polygons = random_area(random, 5 + 10 * shape);
    const Region region(polygons);
    for (int i = 0; i < 2000; ++i) {
      const Point2 p(random.uniform(-55, 55), random.uniform(-55, 55));
      const bool inside = std::any_of(polygons.begin(), polygons.end(),
                                      [&](const Polygon& one) { return contains(one, p); });
      ASSERT_EQ(region.contains(p), inside) << p.transpose() << " shape " << shape;
    }
  }
}

TEST(Region, OutlineContainmentAgreesWithSetOperations) {
  RandomStream random(2, "region outlines");
  int inside_count = 0;
  int outside_count = 0;
  for (int shape = 0; shape < 25; ++shape) {
    const auto polygons = random_area(random, 8 + 4 * shape);
    const Region region(polygons);
    for (int i = 0; i < 200; ++i) {
      const Footprint footprint{random.uniform(0.2, 6.0), random.uniform(0.0, 2.0),
                                random.uniform(0.2, 4.0)};
      const double margin = random.uniform(0.0, 1.0);
      const Pose2 pose{random.uniform(-45, 45), random.uniform(-45, 45), random.uniform(-7, 7)};
      const double outside = area_outside(outline(pose, footprint, margin), polygons);
      if (outside > 0.0 && outside < 1e-6) continue;  // too near the border to tell
      ASSERT_EQ(region.contains(pose, footprint, margin), outside == 0.0)
          << pose.x << " " << pose.y << " " << pose.yaw << " shape " << shape;
      ++(outside == 0.0 ? inside_count : outside_count);
    }
  }
  EXPECT_GT(inside_count, 500);
  EXPECT_GT(outside_count, 500);
}

TEST(Region, AHoleSmallerThanTheVehicleIsSeen) {
  const Region region(subtract({rectangle(0, 0, 20, 20)}, {rectangle(9.9, 9.9, 10.1, 10.1)}));
  EXPECT_FALSE(region.contains(Pose2{9, 10, 0}, Footprint{2.5, 0.5, 1.5}));
  EXPECT_TRUE(region.contains(Pose2{9, 12, 0}, Footprint{2.5, 0.5, 1.5}));
}

TEST(Region, AnOutlineMayTouchTheBorderButNotPassIt) {
  const Region region({rectangle(0, 0, 10, 10)});
  const Footprint footprint{2.0, 1.0, 2.0};
  EXPECT_TRUE(region.contains(Pose2{8, 1, 0}, footprint));
  EXPECT_TRUE(region.contains(Pose2{1, 1, 0}, footprint));
  EXPECT_FALSE(region.contains(Pose2{8.001, 5, 0}, footprint));
  EXPECT_FALSE(region.contains(Pose2{5, 0.999, 0}, footprint));
  EXPECT_TRUE(region.contains(Pose2{5, 1.5, 0}, footprint, 0.5));
  EXPECT_FALSE(region.contains(Pose2{5, 1.5, 0}, footprint, 0.501));
}

TEST(Region, PolygonsThatShareABorderAreOneArea) {
  const Region region({rectangle(0, 0, 10, 10), rectangle(10, 2, 20, 8), rectangle(15, 0, 30, 10)});
  EXPECT_TRUE(region.contains(Pose2{9, 5, 0}, Footprint{2.5, 0.5, 1.5}));
  EXPECT_TRUE(region.contains(Pose2{16, 5, kPi}, Footprint{2.5, 0.5, 1.5}));
  EXPECT_DOUBLE_EQ(region.area(), 100 + 30 + 150);
  EXPECT_EQ(region.polygons().size(), 1u);
}

TEST(Region, NothingIsInsideAnEmptyOne) {
  EXPECT_FALSE(Region().contains(Point2{0, 0}));
  EXPECT_FALSE(Region().contains(Pose2{}, Footprint{}));
  EXPECT_FALSE(Region(std::vector<Polygon>{}).contains(Point2{0, 0}));
  const Region region({rectangle(0, 0, 10, 10)});
  EXPECT_FALSE(region.contains(Point2{1e12, -1e12}));
  EXPECT_FALSE(region.contains(Point2{std::nan(""), 1}));
  EXPECT_FALSE(region.contains(Pose2{1e12, 0, 0}, Footprint{}));
  EXPECT_FALSE(region.contains(Pose2{5, 5, std::nan("")}, Footprint{}));
}

TEST(Region, AQueryAmongAThousandEdgesTakesMicrosecondsAtMost) {
  RandomStream random(3, "region speed");
  const Region region(random_area(random, 1000));
  constexpr int kQueries = 200000;
  int inside = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kQueries; ++i) {
    const Pose2 pose{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-4, 4)};
    inside += region.contains(pose, Footprint{2.5, 0.5, 1.5}, 0.2) ? 1 : 0;
  }
  const std::chrono::duration<double, std::micro> spent = std::chrono::steady_clock::now() - start;
  RecordProperty("us_per_query", std::to_string(spent.count() / kQueries));
  EXPECT_GT(inside, kQueries / 10);
  EXPECT_LT(spent.count() / kQueries, 20.0);  // loose: also holds on a busy machine and in Debug
}

}  // namespace
}  // namespace headland
