// SPDX-License-Identifier: Apache-2.0
#include "sim/crowd/neighbors.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

std::vector<Neighbor> by_brute_force(const std::vector<Point2>& points, std::size_t self,
                                     double range, std::size_t most) {
  std::vector<Neighbor> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double dx = points[i].x() - points[self].x();
    const double dy = points[i].y() - points[self].y();
    const double distance2 = dx * dx + dy * dy;
    if (i != self && distance2 < range * range) all.push_back({distance2, static_cast<int>(i)});
  }
  std::sort(all.begin(), all.end());
  all.resize(std::min(all.size(), most));
  return all;
}

// Whether all neighbours are those of brute force, while the points move as `move` says.
void expect_exact(std::vector<Point2> points, double range, std::size_t most,
                  const std::function<void(std::vector<Point2>&)>& move) {
  Neighbors neighbors;
  for (int step = 0; step < 5; ++step) {
    neighbors.update(points, range, most);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto found = neighbors.of(i);
      const auto expected = by_brute_force(points, i, range, most);
      ASSERT_EQ(found.size(), expected.size()) << "point " << i << ", step " << step;
      for (std::size_t k = 0; k < found.size(); ++k) {
        ASSERT_EQ(found[k].index, expected[k].index) << "point " << i << ", step " << step;
        ASSERT_EQ(found[k].distance2, expected[k].distance2);
      }
    }
    move(points);
  }
}

TEST(Neighbors, TheyAreThoseOfBruteForceWhileThePointsMove) {
  RandomStream random(1, "neighbors");
  for (const int count : {0, 1, 2, 16, 17, 33, 400}) {
    for (const std::size_t most : {std::size_t{0}, std::size_t{1}, std::size_t{10}}) {
      std::vector<Point2> points;
      for (int i = 0; i < count; ++i) {
        points.emplace_back(random.uniform(0.0, 40.0), random.uniform(0.0, 40.0));
      }
      expect_exact(points, 6.0, most, [&random](std::vector<Point2>& all) {
        for (Point2& p : all) p += Point2(random.normal(), random.normal());
      });
    }
  }
}

TEST(Neighbors, CrowdsAtOnePlaceTiesAndPointsFarAwayAreExactToo) {
  std::vector<Point2> points(100, Point2(3.0, 4.0));
  for (int i = 0; i < 100; ++i) points.emplace_back(i % 10, i / 10);  // a lattice: many ties
  points.emplace_back(1e9, -1e9);
  points.emplace_back(-1e15, 7.0);
  expect_exact(points, 3.0, 10, [](std::vector<Point2>& all) {
    std::rotate(all.begin(), all.begin() + 37, all.end());
  });
}

TEST(Neighbors, ThoseOfOneScaleAreFoundAtAnother) {
  RandomStream random(2, "neighbors");
  std::vector<Point2> points;
  for (int i = 0; i < 200; ++i) {
    const double radius = std::pow(10.0, random.uniform(-3.0, 4.0));
    const double angle = random.uniform(0.0, 6.28);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  expect_exact(points, 1e9, 7, [](std::vector<Point2>& all) {
    for (Point2& p : all) p *= 0.5;
  });
}

TEST(Neighbors, AnUpdateOfAsManyPointsDoesNotAllocate) {
  RandomStream random(3, "neighbors");
  std::vector<Point2> points;
  for (int i = 0; i < 500; ++i) {
    points.emplace_back(random.uniform(0.0, 70.0), random.uniform(0.0, 70.0));
  }
  Neighbors neighbors;
  neighbors.update(points, 10.0, 10);
  const long before = testing::allocation_count();
  for (int step = 0; step < 20; ++step) {
    for (Point2& p : points) p = 0.8 * p + 0.1 * Point2(random.normal(), random.normal());
    neighbors.update(points, 10.0, 10);
  }
  EXPECT_EQ(testing::allocation_count(), before);
}

}  // namespace
}  // namespace headland
