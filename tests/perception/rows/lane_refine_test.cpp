// SPDX-License-Identifier: Apache-2.0
#include "perception/rows/lane_refine.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "core/geometry/angle.hpp"
#include "perception/rows/lane_search.hpp"

namespace headland {
namespace {

using internal::Column;

// Columns along rows at the given distances, turned by `heading`.
std::vector<Column> rows_at(std::initializer_list<double> distances, double heading, double noise,
                            RandomStream& random) {
  std::vector<Column> columns;
  for (const double distance : distances) {
    for (double u = -8.0; u < 12.0; u += 0.1) {
      const double v = distance + noise * random.normal();
      columns.push_back({static_cast<float>(std::cos(heading) * u - std::sin(heading) * v),
                         static_cast<float>(std::sin(heading) * u + std::cos(heading) * v), 1.0f});
    }
  }
  return columns;
}

TEST(LaneSearch, TakesTheLaneTheRobotStandsInAmongManyRows) {
  RandomStream random(3, "columns");
  const double heading = deg_to_rad(5.0);
  auto columns = rows_at({-3.7, -1.2, 1.2, 3.8, 6.3}, heading, 0.1, random);
  // The rows beyond are denser.
  for (const Column& column : rows_at({3.8, 3.8, 6.3, 6.3}, heading, 0.1, random)) {
    columns.push_back(column);
  }
  LaneSearch search{LaneSearchConfig{}};
  const auto lane = search.search(columns, 2.5, 0.0);
  ASSERT_TRUE(lane.has_value());
  EXPECT_NEAR(lane->heading_rad, heading, deg_to_rad(0.75));
  EXPECT_NEAR(lane->left_m, 1.2, 0.25);
  EXPECT_NEAR(lane->right_m, -1.2, 0.25);
}

TEST(LaneSearch, WithoutColumnsThereIsNoLane) {
  LaneSearch search{LaneSearchConfig{}};
  EXPECT_FALSE(search.search({}, 2.5, 0.0).has_value());
}

TEST(LaneRefine, AgreesWithTheClosedFormOfTwoParallelLines) {
  RandomStream random(3, "columns");
  const auto columns = rows_at({-2.1, 1.7}, 0.08, 0.05, random);
  // theta = 1/2 atan2(2 sum Sxy, sum (Sxx - Syy)) over both lines.
  double sxx = 0.0;
  double sxy = 0.0;
  double syy = 0.0;
  const std::size_t half = columns.size() / 2;
  for (std::size_t row = 0; row < 2; ++row) {
    double x = 0.0;
    double y = 0.0;
    for (std::size_t i = row * half; i < (row + 1) * half; ++i) {
      x += columns[i].x / static_cast<double>(half);
      y += columns[i].y / static_cast<double>(half);
    }
    for (std::size_t i = row * half; i < (row + 1) * half; ++i) {
      sxx += (columns[i].x - x) * (columns[i].x - x);
      sxy += (columns[i].x - x) * (columns[i].y - y);
      syy += (columns[i].y - y) * (columns[i].y - y);
    }
  }
  const double theta = 0.5 * std::atan2(2.0 * sxy, sxx - syy);
  LaneRefineConfig config;
  config.curvature_1pm = 1e-9;
  LaneRefine refine(config);
  const LaneFit fit = refine.refine(columns, {0.06, 1.8, -2.0}, 3.8);
  EXPECT_NEAR(fit.heading_rad, theta, 5e-4);
  EXPECT_NEAR(fit.offset_m, -0.2, 0.01);
  EXPECT_NEAR(fit.width_m, 3.8, 0.02);
}

TEST(LaneRefine, FollowsACurvedRow) {
  RandomStream random(3, "columns");
  auto columns = rows_at({-1.9, 1.9}, 0.0, 0.03, random);
  const double curvature = 0.004;
  for (Column& column : columns) {
    column.y += static_cast<float>(0.5 * curvature * column.x * column.x);
  }
  LaneRefine refine{LaneRefineConfig{}};
  const LaneFit fit = refine.refine(columns, {0.0, 1.9, -1.9}, 3.8);
  EXPECT_NEAR(fit.offset_m, 0.0, 0.02);
  EXPECT_NEAR(fit.heading_rad, 0.0, 0.003);
  EXPECT_NEAR(fit.curvature_1pm, curvature, 0.001);
}

TEST(LaneRefine, PeopleBesideTheRowHardlyMoveIt) {
  RandomStream random(3, "columns");
  auto columns = rows_at({-1.9, 1.9}, 0.0, 0.05, random);
  for (int i = 0; i < 25; ++i) {
    columns.push_back({static_cast<float>(3.0 + 0.4 * random.uniform()),
                       static_cast<float>(1.2 + 0.3 * random.uniform()), 1.0f});
  }
  LaneRefine refine{LaneRefineConfig{}};
  const LaneFit fit = refine.refine(columns, {0.0, 1.8, -1.9}, 3.8);
  EXPECT_NEAR(fit.offset_m, 0.0, 0.02);
}

TEST(LaneRefine, SaysHowSureItIs) {
  // Errors against the covariance it states, over many draws.
  int within = 0;
  const int draws = 200;
  LaneRefine refine{LaneRefineConfig{}};
  for (int i = 0; i < draws; ++i) {
    RandomStream random(static_cast<std::uint64_t>(i), "columns");
    std::vector<Column> columns;
    for (const double row : {-1.9, 1.9}) {
      for (double u = -9.75; u < 12.0; u += 0.5) {
        const double plant = row + 0.12 * random.normal();
        for (int k = 0; k < 5; ++k) {
          columns.push_back({static_cast<float>(u), static_cast<float>(plant), 1.0f});
        }
      }
    }
    const LaneFit fit = refine.refine(columns, {0.0, 1.9, -1.9}, 3.8);
    within += std::abs(fit.offset_m) < 2.0 * std::sqrt(fit.covariance(0, 0)) ? 1 : 0;
  }
  EXPECT_GE(within, draws * 90 / 100);
  EXPECT_LT(within, draws);
}

TEST(LaneRefine, OneRowLeavesTheWidthAsItWas) {
  RandomStream random(3, "columns");
  const auto columns = rows_at({1.8}, 0.0, 0.03, random);
  LaneRefine refine{LaneRefineConfig{}};
  const LaneFit fit = refine.refine(columns, {0.0, 1.9, -1.9}, 3.8);
  EXPECT_NEAR(fit.width_m, 3.8, 0.01);
  EXPECT_NEAR(fit.offset_m, -0.1, 0.02);
  EXPECT_EQ(fit.stations[0], 0);
  EXPECT_GT(fit.stations[1], 20);
}

}  // namespace
}  // namespace headland
