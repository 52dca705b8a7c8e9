// SPDX-License-Identifier: Apache-2.0
#include "core/world/terrain.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// z = 3 + x / 4 - y / 8 on a grid of 2 m.
Terrain slope() {
  std::vector<double> heights;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 5; ++column) {
      heights.push_back(3.0 + 0.25 * (10.0 + 2.0 * column) - 0.125 * (20.0 + 2.0 * row));
    }
  }
  return Terrain::from_grid({10.0, 20.0}, 2.0, 5, 4, heights);
}

Terrain rough(double bad = 0.0) {
  RandomStream random(7, "heights");
  std::vector<double> heights;
  for (int i = 0; i < 30; ++i) heights.push_back(random.uniform(0.0, 10.0));
  if (std::isnan(bad)) heights[14] = bad;  // column 2 of row 2
  return Terrain::from_grid({-3.0, 4.0}, 1.5, 6, 5, heights);
}

TEST(Terrain, APlaneIsExactEverywhereUpToItsBorder) {
  const Terrain terrain = slope();
  EXPECT_EQ(terrain.cell(), 2.0);
  for (const double x : {10.0, 10.3, 12.0, 17.9, 18.0}) {
    for (const double y : {20.0, 21.7, 24.0, 26.0}) {
      const auto found = terrain.at({x, y});
      ASSERT_TRUE(found) << x << " " << y;
      EXPECT_NEAR(found->height, 3.0 + 0.25 * x - 0.125 * y, 1e-12);
      EXPECT_NEAR(found->gradient.x(), 0.25, 1e-12);
      EXPECT_NEAR(found->gradient.y(), -0.125, 1e-12);
    }
  }
}

TEST(Terrain, OutsideTheGridIsAnErrorThatNamesThePlace) {
  const Terrain terrain = slope();
  for (const Point2& p : {Point2(9.99, 21.0), Point2(18.01, 21.0), Point2(12.0, 19.99),
                          Point2(12.0, 26.01), Point2(kNaN, 21.0), Point2(12.0, 1e300)}) {
    EXPECT_FALSE(terrain.sample(p)) << p.transpose();
    const auto found = terrain.at(p);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, ErrorCode::kOffTerrain);
  }
  EXPECT_THAT(terrain.at({1.0, 2.0}).error().what, ::testing::HasSubstr("(1.0, 2.0) m"));
}

TEST(Terrain, CellsBesideAPointWithoutDataHaveNoHeight) {
  const Terrain terrain = rough(kNaN);
  int missing = 0;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 5; ++column) {
      const Point2 middle(-3.0 + 1.5 * (column + 0.5), 4.0 + 1.5 * (row + 0.5));
      const bool beside = (column == 1 || column == 2) && (row == 1 || row == 2);
      EXPECT_EQ(terrain.sample(middle).has_value(), !beside) << column << " " << row;
      missing += beside ? 1 : 0;
    }
  }
  EXPECT_EQ(missing, 4);
}

TEST(Terrain, TheGradientIsThatOfTheHeight) {
  const Terrain terrain = rough();
  RandomStream random(1, "points");
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 200; ++i) {
    // Inside one cell, so that both sides of the difference lie on the same surface.
    const Point2 p(-3.0 + 1.5 * (random.index(5) + random.uniform(0.01, 0.99)),
                   4.0 + 1.5 * (random.index(4) + random.uniform(0.01, 0.99)));
    const auto height = [&](double dx, double dy) {
      return terrain.sample(p + Point2(dx, dy))->height;
    };
    const Point2 gradient = terrain.sample(p)->gradient;
    EXPECT_NEAR(gradient.x(), (height(kStep, 0) - height(-kStep, 0)) / (2 * kStep), 1e-8);
    EXPECT_NEAR(gradient.y(), (height(0, kStep) - height(0, -kStep)) / (2 * kStep), 1e-8);
  }
}

TEST(Terrain, HeightsHaveNoStepBetweenCells) {
  const Terrain terrain = rough();
  for (int i = 1; i < 5; ++i) {
    const double x = -3.0 + 1.5 * i;
    const double left = terrain.sample({x - 1e-9, 6.2})->height;
    EXPECT_NEAR(terrain.sample({x + 1e-9, 6.2})->height, left, 1e-7);
  }
}

TEST(Terrain, HillsHaveExactlyTheirRelief) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const HillSpec spec{seed, 17.0, 150.0, 2.0};
    const Terrain hills = Terrain::hills(spec, {-100.0, 50.0}, {301.0, 250.0});
    double lowest = 1e9;
    double highest = -1e9;
    for (double x = -100.0; x <= 302.0; x += 2.0) {
      for (double y = 50.0; y <= 250.0; y += 2.0) {
        const auto found = hills.sample({x, y});
        ASSERT_TRUE(found) << x << " " << y;
        lowest = std::min(lowest, found->height);
        highest = std::max(highest, found->height);
      }
    }
    EXPECT_NEAR(lowest, 0.0, 1e-12);
    EXPECT_NEAR(highest, 17.0, 1e-12);
  }
}

TEST(Terrain, HillsAreHillsNotSlopesOrSpikes) {
  const HillSpec spec{5, 20.0, 200.0, 2.0};
  const Terrain hills = Terrain::hills(spec, {0.0, 0.0}, {800.0, 800.0});
  double steepest = 0.0;
  int crossings = 0;  // of the middle height, along one line
  bool above = false;
  for (double x = 0.0; x <= 800.0; x += 2.0) {
    const TerrainSample here = *hills.sample({x, 400.0});
    steepest = std::max(steepest, here.gradient.norm());
    crossings += x > 0.0 && (here.height > 10.0) != above ? 1 : 0;
    above = here.height > 10.0;
  }
  EXPECT_GE(crossings, 3);
  EXPECT_LT(steepest, 0.8);  // 2 pi x 20 m / 200 m = 0.63 for a single wave
  EXPECT_GT(steepest, 0.1);
}

TEST(Terrain, SameSeedSameHillsAndOtherSeedsOthers) {
  const auto print = [](const HillSpec& spec) {
    return Terrain::hills(spec, {0.0, 0.0}, {100.0, 80.0}).fingerprint();
  };
  const HillSpec spec{1, 20.0, 200.0, 2.0};
  EXPECT_EQ(print(spec), print(spec));
  EXPECT_NE(print(spec), print({2, 20.0, 200.0, 2.0}));
  EXPECT_NE(print(spec), print({1, 21.0, 200.0, 2.0}));
  EXPECT_NE(print(spec), print({1, 20.0, 190.0, 2.0}));
  EXPECT_NE(print(spec), print({1, 20.0, 200.0, 4.0}));
}

TEST(Terrain, FingerprintsTellGridsApart) {
  EXPECT_NE(slope().fingerprint(), rough().fingerprint());
  EXPECT_NE(rough().fingerprint(), rough(kNaN).fingerprint());
  const std::vector<double> flat(4, 1.0);
  EXPECT_NE(Terrain::from_grid({0.0, 0.0}, 1.0, 2, 2, flat).fingerprint(),
            Terrain::from_grid({0.0, 1.0}, 1.0, 2, 2, flat).fingerprint());
}

}  // namespace
}  // namespace headland
