// SPDX-License-Identifier: Apache-2.0
#include "perception/ground/height_grid.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "perception/cloud/cloud.hpp"
#include "tests/perception/cloud/real_clouds.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

float f(double x) { return static_cast<float>(x); }

// A point every 0.2 m of a square of 40 m, with 1 cm noise, `terrain(x, y)` being the height.
template <class Terrain>
std::vector<LidarPoint> field(Terrain terrain, std::uint64_t seed = 1) {
  RandomStream random(seed, "field");
  std::vector<LidarPoint> points;
  for (double x = -20.0; x < 20.0; x += 0.2) {
    for (double y = -20.0; y < 20.0; y += 0.2) {
      points.push_back({{f(x), f(y), f(terrain(x, y) + 0.01 * random.normal())}, 0, 0, 0});
    }
  }
  return points;
}

double share_of_ground(const HeightGrid& grid, std::size_t from, std::size_t to) {
  int ground = 0;
  for (std::size_t i = from; i < to; ++i) ground += grid.labels()[i] == GroundLabel::kGround;
  return static_cast<double>(ground) / static_cast<double>(to - from);
}

TEST(HeightGrid, KnowsHeightAndSlopeOfHills) {
  const auto hill = [](double x, double y) {
    return 2.0 * std::sin(0.1 * x) + 0.1 * y;  // at most 22 %
  };
  HeightGrid grid;
  const auto points = field(hill);
  grid.update(points, {0.0, 0.0});
  EXPECT_GT(share_of_ground(grid, 0, points.size()), 0.999);
  for (double x = -15.0; x < 15.0; x += 1.7) {
    for (double y = -15.0; y < 15.0; y += 2.3) {
      ASSERT_TRUE(grid.height({x, y}));
      EXPECT_NEAR(*grid.height({x, y}), hill(x, y), 0.05);
      EXPECT_NEAR(grid.at({x, y})->slope, std::hypot(0.2 * std::cos(0.1 * x), 0.1), 0.06);
      EXPECT_LT(grid.at({x, y})->step, 0.06);
    }
  }
}

TEST(HeightGrid, TellsWhatStandsOnTheGround) {
  auto points = field([](double x, double) { return 0.1 * x; });
  const std::size_t ground = points.size();
  RandomStream random(2, "objects");
  for (int i = 0; i < 2000; ++i) {  // a hedge, 1 m wide and 2 m high, and a shed of 6 m by 5 m
    const double x = random.uniform(-10.0, 10.0);
    points.push_back(
        {{f(x), f(random.uniform(4.0, 5.0)), f(0.1 * x + random.uniform(0.4, 2.0))}, 0, 0, 0});
  }
  for (LidarPoint& point : points) {
    Eigen::Vector3f& p = point.position;
    if (std::abs(p.x() + 8.0f) < 3.0f && std::abs(p.y() + 8.0f) < 2.5f) p.z() = 3.0f;
  }
  HeightGrid grid;
  grid.update(points, {0.0, 0.0});
  EXPECT_LT(share_of_ground(grid, ground, points.size()), 0.01);
  for (std::size_t i = 0; i < ground; ++i) {
    ASSERT_EQ(grid.labels()[i] == GroundLabel::kGround, points[i].position.z() < 2.9f) << i;
  }
  EXPECT_GT(grid.at({0.25, 4.75})->obstacle, 1.5f);
  EXPECT_EQ(grid.at({0.25, 4.75})->traversability, 0.0f);
  EXPECT_GT(grid.at({0.25, -4.75})->traversability, 0.5f);
  EXPECT_FALSE(grid.at({-8.0, -8.0})) << "no ground is seen under the shed";
}

TEST(HeightGrid, ATerraceIsAStepNotASlope) {
  const auto terrace = [](double x, double) { return x < 4.9 ? 0.0 : 1.0; };
  HeightGrid grid;
  const auto points = field(terrace);
  grid.update(points, {0.0, 0.0});
  EXPECT_GT(share_of_ground(grid, 0, points.size()), 0.98) << "both levels are ground";
  EXPECT_NEAR(grid.at({4.75, 0.25})->step, 1.0, 0.05);
  EXPECT_NEAR(grid.at({4.75, 0.25})->slope, 0.0, 0.05);
  EXPECT_EQ(grid.at({4.75, 0.25})->traversability, 0.0f);
  EXPECT_GT(grid.at({2.75, 0.25})->traversability, 0.7f);
}

TEST(HeightGrid, RoughGroundIsRough) {
  RandomStream random(3, "rough");
  HeightGrid grid;
  grid.update(field([&](double x, double) { return x < 0.0 ? 0.0 : random.uniform(0.0, 0.15); }),
              {0.0, 0.0});
  EXPECT_LT(grid.at({-5.25, 0.25})->roughness, 0.03f);
  EXPECT_NEAR(grid.at({5.25, 0.25})->roughness, 0.15 / std::sqrt(12.0), 0.03);
  EXPECT_LT(grid.at({5.25, 0.25})->traversability, grid.at({-5.25, 0.25})->traversability);
}

TEST(HeightGrid, BecomesSurerFromScanToScan) {
  HeightGridConfig config;
  config.settling_m = 0.0;
  HeightGrid grid(config);
  float last = std::numeric_limits<float>::infinity();
  for (int scan = 0; scan < 10; ++scan) {
    grid.update(field([](double, double) { return 0.3; }, static_cast<std::uint64_t>(scan)),
                {0.0, 0.0});
    const float variance = grid.at({1.25, 1.25})->variance;
    EXPECT_LT(variance, last);
    last = variance;
  }
  EXPECT_NEAR(grid.at({1.25, 1.25})->height, 0.3, 0.005);
  const auto empty = grid.at({1.25, 1.25});
  grid.update({}, {0.0, 0.0});
  EXPECT_EQ(grid.at({1.25, 1.25})->height, empty->height) << "unseen ground stays";
}

TEST(HeightGrid, WhatLeavesWasNoGround) {
  const auto parked = [](double x, double y) {
    return std::abs(x) < 10.0 && std::abs(y) < 10.0 ? 1.5 : 0.0;  // wider than any object
  };
  HeightGrid grid;
  grid.update(field(parked), {0.0, 0.0});
  ASSERT_TRUE(grid.height({0.25, 0.25}));
  EXPECT_NEAR(*grid.height({0.25, 0.25}), 1.5, 0.05);
  grid.update(field([](double, double) { return 0.0; }), {0.0, 0.0});
  EXPECT_NEAR(*grid.height({0.25, 0.25}), 0.0, 0.05);
  grid.update(field(parked), {0.0, 0.0});
  EXPECT_NEAR(*grid.height({0.25, 0.25}), 0.0, 0.05) << "ground is the lowest";
}

TEST(HeightGrid, TheWindowMovesAndCellsKeepTheirPlace) {
  HeightGrid grid;
  const auto points = field([](double x, double y) { return 0.05 * x - 0.02 * y; });
  grid.update(points, {0.0, 0.0});
  const double before = *grid.height({3.1, 4.2});
  for (const Point2& center : {Point2{10.3, -7.9}, {-5.2, 20.1}, {0.0, 0.0}}) {
    grid.update({}, center);
    EXPECT_NEAR(*grid.height({3.1, 4.2}), before, 1e-5);
  }
  grid.update({}, {1000.0, 0.0});
  EXPECT_FALSE(grid.height({3.1, 4.2}));
  grid.update({}, {0.0, 0.0});
  EXPECT_FALSE(grid.height({3.1, 4.2})) << "what has left is forgotten";
  grid.update(points, {0.0, 0.0});
  grid.clear();
  EXPECT_FALSE(grid.height({3.1, 4.2}));
}

TEST(HeightGrid, BadInputGivesNoGround) {
  HeightGrid grid;
  std::vector<LidarPoint> points(3);
  points[0].position = {std::numeric_limits<float>::quiet_NaN(), 0, 0};
  points[1].position = {0, 0, std::numeric_limits<float>::infinity()};
  points[2].position = {1e6f, 0, 0};
  grid.update(points, {std::nan(""), 0.0});
  for (const GroundLabel label : grid.labels()) EXPECT_EQ(label, GroundLabel::kOutside);
  EXPECT_FALSE(grid.height({0.0, 0.0}));
  EXPECT_FALSE(grid.height({std::nan(""), 0.0}));
}

TEST(HeightGrid, ErrorsBelowTheGroundAreLeftOut) {
  auto points = field([](double, double) { return 0.0; });
  points.push_back({{3.1f, 3.1f, -4.0f}, 0, 0, 0});
  HeightGrid grid;
  grid.update(points, {0.0, 0.0});
  EXPECT_NEAR(*grid.height({3.1, 3.1}), 0.0, 0.05);
  EXPECT_EQ(grid.labels().back(), GroundLabel::kObject);
}

TEST(HeightGrid, DoesNotAllocateOnceWarm) {
  const auto points = field([](double, double) { return 0.0; });
  HeightGrid grid;
  grid.update(points, {0.0, 0.0});
  const long before = testing::allocation_count();
  grid.update(points, {1.0, 0.0});
  EXPECT_EQ(testing::allocation_count(), before);
}

// ISPRS filter test (Sithole and Vosselman 2004), with one configuration for all samples: towns and
// woods on steep slopes, a bridge, a station, a quarry. Bounds: [%] of the first run, rounded up.
struct IsprsSample {
  const char* name;
  double type1_percent;  ///< ground taken for objects
  double type2_percent;  ///< objects taken for ground
  double total_percent;
};
class HeightGridOnIsprs : public ::testing::TestWithParam<IsprsSample> {};

TEST_P(HeightGridOnIsprs, SeparatesGroundFromObjects) {
  const std::string name = std::string("isprs/") + GetParam().name;
  const auto all_file = real_cloud(name + "-utm.pcd");
  const auto ground_file = real_cloud(name + "-utm-ground.pcd");
  if (!all_file || !ground_file) GTEST_SKIP() << "no data";
  const auto all = load_cloud(*all_file);
  const auto ground = load_cloud(*ground_file);
  ASSERT_TRUE(all && ground);
  using Place = std::tuple<float, float, float>;
  const auto place = [](const LidarPoint& p) {
    return Place{p.position.x(), p.position.y(), p.position.z()};
  };
  std::map<Place, int> reference;
  for (const LidarPoint& point : ground->points) ++reference[place(point)];
  Eigen::AlignedBox3f box;
  for (const LidarPoint& point : all->points) box.extend(point.position);

  HeightGridConfig config;
  config.cell_m = 1.0;
  config.reach_m = 0.5 * static_cast<double>(box.sizes().head<2>().maxCoeff()) + 2.0;
  config.widest_object_m = 50.0;
  config.range_noise_m = 0.1;
  config.least_rise_m = 0.3;
  config.label_band_m = 0.4;
  HeightGrid grid(config);
  grid.update(all->points, box.center().head<2>().cast<double>());

  int count[2][2] = {};  // by truth and label
  for (std::size_t i = 0; i < all->points.size(); ++i) {
    const bool truth = reference[place(all->points[i])]-- > 0;
    ++count[truth][grid.labels()[i] == GroundLabel::kGround];
  }
  const double type1 = 100.0 * count[1][0] / (count[1][0] + count[1][1]);
  const double type2 = 100.0 * count[0][1] / (count[0][0] + count[0][1]);
  const double total =
      100.0 * (count[1][0] + count[0][1]) / static_cast<double>(all->points.size());
  RecordProperty("type1_percent", std::to_string(type1));
  RecordProperty("type2_percent", std::to_string(type2));
  RecordProperty("total_percent", std::to_string(total));
  EXPECT_LT(type1, GetParam().type1_percent);
  EXPECT_LT(type2, GetParam().type2_percent);
  EXPECT_LT(total, GetParam().total_percent);
}

INSTANTIATE_TEST_SUITE_P(All, HeightGridOnIsprs,
                         ::testing::Values(IsprsSample{"samp11", 10.5, 10.5, 10.5},
                                           IsprsSample{"samp21", 0.2, 10.5, 2.5},
                                           IsprsSample{"samp31", 0.2, 6.5, 3.0},
                                           IsprsSample{"samp42", 0.3, 5.0, 3.5},
                                           IsprsSample{"samp53", 4.0, 18.0, 4.5}));

}  // namespace
}  // namespace headland
