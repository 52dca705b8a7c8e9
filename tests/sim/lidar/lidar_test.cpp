// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/lidar.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

constexpr double kHeight = 1.45;

SensorMount mount(double roll_deg = 0.0) {
  SensorMount at;
  at.z_m = kHeight;
  at.roll_deg = roll_deg;
  return at;
}

// Bare soil and nothing else.
LidarScene soil() {
  RowLayout layout;
  layout.rows_count = 0;
  OrchardConfig config;
  config.grass_area_density_1pm = 0.0;
  return LidarScene::rows(layout, config, 1);
}

LidarConfig exact() {
  LidarConfig config;
  config.noise_m = 0.0;
  config.noise_ratio = 0.0;
  config.dropout_probability = 0.0;
  config.stray_probability = 0.0;
  config.sub_rays_count = 1;
  return config;
}

Eigen::Isometry3d at(double x, double y, double z, double yaw) {
  return Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
}

std::function<Eigen::Isometry3d(double)> standing(const Eigen::Isometry3d& pose) {
  return [pose](double) { return pose; };
}

TEST(Lidar, ATurnHasItsShotsInTheirOrder) {
  LidarConfig config = exact();
  config.stray_probability = 1.0;  // each shot gives a point
  LidarSimulator lidar(config, mount(), 1);
  LidarScan scan;
  lidar.scan(soil(), standing(at(0, 0, 0, 0)), 12.5, scan);
  EXPECT_EQ(scan.time_s, 12.5);
  ASSERT_EQ(scan.points.size(), 28800u);
  ASSERT_EQ(lidar.truth().size(), 28800u);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const LidarPoint& point = scan.points[i];
    EXPECT_EQ(point.ring, i % 16);
    if (i > 0) {
      EXPECT_GT(point.offset_s, scan.points[i - 1].offset_s);
    }
    const float elevation = std::atan2(point.position.z(), point.position.head<2>().norm());
    EXPECT_NEAR(elevation, deg_to_rad(-15.0 + 2.0 * point.ring), 1e-5);
  }
  EXPECT_NEAR(scan.points.back().offset_s, 0.1, 1e-4);
  EXPECT_NEAR(lidar.duration(), 0.1, 1e-12);
  // Clockwise: a quarter turn after the start at the rear it looks to the left, then ahead.
  EXPECT_GT(scan.points[28800 / 4].position.y(), 0.0f);
  EXPECT_GT(scan.points[28800 / 2].position.x(), 0.0f);
}

TEST(Lidar, LevelSoilMakesCircles) {
  LidarSimulator lidar(exact(), mount(), 1);
  LidarScan scan;
  lidar.scan(soil(), standing(at(0, 0, 0, 0.3)), 0.0, scan);
  ASSERT_GT(scan.points.size(), 1800u * 6u);
  for (const LidarPoint& point : scan.points) {
    EXPECT_LT(point.ring, 8);
    EXPECT_NEAR(point.position.z(), -kHeight, 0.0025);
    const double range = static_cast<double>(point.position.norm());
    EXPECT_NEAR(std::remainder(range, 0.0025), 0.0, 1e-5);
  }
}

TEST(Lidar, PointsLieInTheSensorAtTheirShot) {
  LidarSimulator lidar(exact(), mount(), 1);
  LidarScan scan;
  Eigen::Isometry3d end = at(0.3, 0.0, 0.0, 0.05);
  end.rotate(Eigen::AngleAxisd(0.06, Eigen::Vector3d::UnitX()));
  const auto motion = linear_motion(at(0, 0, 0, 0), end, lidar.duration());
  lidar.scan(soil(), motion, 0.0, scan);
  double warped = 0.0;
  for (const LidarPoint& point : scan.points) {
    const Eigen::Vector3d p = point.position.cast<double>();
    if (p.norm() > 15.0) continue;
    const double offset = static_cast<double>(point.offset_s);
    EXPECT_NEAR((motion(offset) * mount().pose() * p).z(), 0.0, 0.005);
    warped = std::max(warped, std::abs((mount().pose() * p).z()));
  }
  EXPECT_GT(warped, 0.2);
}

TEST(Lidar, UpsideDownItSeesTheSameWorld) {
  LidarSimulator lidar(exact(), mount(180.0), 1);
  LidarScan scan;
  lidar.scan(soil(), standing(at(0, 0, 0, 0)), 0.0, scan);
  ASSERT_FALSE(scan.points.empty());
  for (const LidarPoint& point : scan.points) {
    EXPECT_GE(point.ring, 8);
    EXPECT_NEAR((mount(180.0).pose() * point.position.cast<double>()).z(), 0.0, 0.0025);
  }
}

TEST(Lidar, RangesAreAsNoisyAsSaid) {
  LidarConfig config = exact();
  config.noise_m = 0.02;
  config.view_begin_deg = -30.0;
  config.view_end_deg = 30.0;
  LidarSimulator lidar(config, mount(), 1);
  LidarScan scan;
  lidar.scan(soil(), standing(at(0, 0, 0, 0)), 0.0, scan);
  double sum = 0.0;
  double squares = 0.0;
  for (const LidarPoint& point : scan.points) {
    const double angle = deg_to_rad(15.0 - 2.0 * point.ring);
    const double error = static_cast<double>(point.position.norm()) - kHeight / std::sin(angle);
    sum += error;
    squares += error * error;
  }
  const auto count = static_cast<double>(scan.points.size());
  EXPECT_NEAR(sum / count, 0.0, 0.002);
  EXPECT_NEAR(std::sqrt(squares / count), 0.02, 0.002);
}

TEST(Lidar, LossesAndStraysComeAtTheirRate) {
  LidarConfig config = exact();
  LidarScan scan;
  LidarSimulator(config, mount(), 1).scan(soil(), standing(at(0, 0, 0, 0)), 0.0, scan);
  const auto all = static_cast<double>(scan.points.size());
  config.dropout_probability = 0.25;
  LidarSimulator(config, mount(), 1).scan(soil(), standing(at(0, 0, 0, 0)), 0.0, scan);
  EXPECT_NEAR(static_cast<double>(scan.points.size()), 0.75 * all, 0.02 * all);
  config.dropout_probability = 1.0;
  config.stray_probability = 0.01;
  LidarSimulator lidar(config, mount(), 1);
  lidar.scan(soil(), standing(at(0, 0, 0, 0)), 0.0, scan);
  EXPECT_NEAR(static_cast<double>(scan.points.size()), 288.0, 60.0);
  for (const PointTruth& truth : lidar.truth()) EXPECT_EQ(truth.surface, Surface::kNone);
}

TEST(Lidar, DarkThingsAreLostFartherAway) {
  LidarConfig config = exact();
  config.far_dark_m = 10.0;
  LidarScan scan;
  LidarSimulator(config, mount(), 1).scan(soil(), standing(at(0, 0, 0, 0)), 0.0, scan);
  double farthest = 0.0;
  for (const LidarPoint& point : scan.points) {
    farthest = std::max(farthest, static_cast<double>(point.position.norm()));
  }
  EXPECT_GT(farthest, 5.0);
  EXPECT_LT(farthest, 10.0);  // soil is lighter, but meets the beam at a flat angle
}

TEST(Lidar, TheChosenEchoDecidesAmongLeaves) {
  const LidarScene scene = LidarScene::rows({}, vineyard(true), 1);
  const auto mean_range = [&](ReturnMode mode) {
    LidarConfig config;
    config.return_mode = mode;
    config.stray_probability = 0.0;
    config.azimuth_step_deg = 1.0;
    LidarScan scan;
    LidarSimulator(config, mount(), 1).scan(scene, standing(at(20, 0, 0, 0)), 0.0, scan);
    double sum = 0.0;
    for (const LidarPoint& point : scan.points) sum += static_cast<double>(point.position.norm());
    return sum / static_cast<double>(scan.points.size());
  };
  EXPECT_LT(mean_range(ReturnMode::kFirst), mean_range(ReturnMode::kStrongest));
  EXPECT_LT(mean_range(ReturnMode::kStrongest), mean_range(ReturnMode::kLast));
}

TEST(Lidar, AnEdgeMakesMixedPixels) {
  LidarScene scene = soil();
  const std::vector<Agent> pair = [] {
    std::vector<Agent> agents(2);
    agents[0].position = {10.0, 0.0};
    agents[1].position = {10.3, 0.25};
    return agents;
  }();
  scene.set_agents(pair);
  LidarConfig config = exact();
  config.sub_rays_count = 9;
  config.divergence_rad = 0.02;
  config.azimuth_step_deg = 0.05;
  config.view_begin_deg = -5.0;
  config.view_end_deg = 5.0;
  config.lasers_count = 1;
  config.lowest_deg = -1.0;
  LidarSimulator lidar(config, mount(), 1);
  LidarScan scan;
  lidar.scan(scene, standing(at(0, 0, 0, 0)), 0.0, scan);
  // Points that lie inside neither body, nor on its front.
  int mixed = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (lidar.truth()[i].surface != Surface::kAgent) continue;
    const Point2 p = scan.points[i].position.head<2>().cast<double>();
    const auto gap = [&](int k) {
      return std::abs((p - pair[static_cast<std::size_t>(k)].position).norm() - 0.25);
    };
    if (std::min(gap(0), gap(1)) > 0.03) ++mixed;
  }
  EXPECT_GT(mixed, 0);
}

TEST(Lidar, PointsKnowWhomTheyHit) {
  LidarScene scene = LidarScene::rows({}, vineyard(true), 1);
  std::vector<Agent> agents(2);
  agents[0].position = {25.0, 0.3};
  agents[1].position = {30.0, -0.4};
  scene.set_agents(agents);
  LidarSimulator lidar({}, mount(), 1);
  LidarScan scan;
  lidar.scan(scene, standing(at(20, 0, 0, 0)), 0.0, scan);
  std::array<int, 2> counts{};
  std::set<Surface> met;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const PointTruth& truth = lidar.truth()[i];
    met.insert(truth.surface);
    if (truth.agent < 0) continue;
    const auto who = static_cast<std::size_t>(truth.agent);
    ++counts[who];
    const Point2 p = scan.points[i].position.head<2>().cast<double>() + Point2(20.0, 0.0);
    EXPECT_LT((p - agents[who].position).norm(), 0.5);
  }
  EXPECT_GT(counts[0], 60);
  EXPECT_GT(counts[1], 10);
  for (const Surface surface : {Surface::kGrass, Surface::kCanopy, Surface::kTrunk, Surface::kPost,
                                Surface::kWire, Surface::kAgent}) {
    EXPECT_TRUE(met.count(surface)) << static_cast<int>(surface);
  }
}

TEST(Lidar, WindMovesTheLeavesAlone) {
  const LidarScene scene = LidarScene::rows({}, vineyard(true), 1);
  LidarConfig config = exact();
  config.resolution_m = 0.0;
  LidarScan calm;
  LidarScan windy;
  LidarSimulator(config, mount(), 1).scan(scene, standing(at(20, 0, 0, 0)), 0.0, calm);
  config.wind_m = 0.05;
  LidarSimulator lidar(config, mount(), 1);
  lidar.scan(scene, standing(at(20, 0, 0, 0)), 0.3, windy);
  ASSERT_EQ(calm.points.size(), windy.points.size());
  double most = 0.0;
  for (std::size_t i = 0; i < calm.points.size(); ++i) {
    const double moved =
        static_cast<double>((calm.points[i].position - windy.points[i].position).norm());
    if (lidar.truth()[i].surface != Surface::kCanopy) {
      EXPECT_LT(moved, 1e-5);
    }
    most = std::max(most, moved);
  }
  EXPECT_GT(most, 0.03);
  EXPECT_LT(most, 0.051);
}

TEST(Lidar, SameSeedSameBytes) {
  const LidarScene scene = LidarScene::rows({}, vineyard(true), 1);
  const auto points = [&](std::uint64_t seed) {
    LidarScan scan;
    LidarSimulator({}, mount(), seed).scan(scene, standing(at(20, 0, 0, 0)), 0.0, scan);
    std::vector<float> numbers;
    for (const LidarPoint& point : scan.points) {
      for (const float value : {point.position.x(), point.position.y(), point.position.z(),
                                point.intensity, point.offset_s}) {
        numbers.push_back(value);
      }
    }
    return numbers;
  };
  EXPECT_EQ(points(7), points(7));
  EXPECT_NE(points(7), points(8));
}

TEST(Lidar, ALostPoseGivesNoPoint) {
  LidarConfig config;
  config.stray_probability = 0.0;
  LidarSimulator lidar(config, mount(), 1);
  LidarScan scan;
  scan.points.resize(5);
  Eigen::Isometry3d nowhere = at(0, 0, 0, 0);
  nowhere.translation().x() = std::numeric_limits<double>::quiet_NaN();
  lidar.scan(soil(), standing(nowhere), 0.0, scan);
  EXPECT_TRUE(scan.points.empty());
}

TEST(Lidar, ASecondScanDoesNotAllocate) {
  const LidarScene scene = LidarScene::rows({}, vineyard(true), 1);
  LidarSimulator lidar({}, mount(), 1);
  LidarScan scan;
  scan.points.reserve(28800);
  const auto pose = standing(at(20, 0, 0, 0));
  lidar.scan(scene, pose, 0.0, scan);
  lidar.scan(scene, pose, 0.1, scan);
  const long before = headland::testing::allocation_count();
  lidar.scan(scene, pose, 0.2, scan);
  EXPECT_EQ(headland::testing::allocation_count(), before);
}

}  // namespace
}  // namespace headland
