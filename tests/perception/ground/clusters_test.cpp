// SPDX-License-Identifier: Apache-2.0
#include "perception/ground/clusters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "perception/cloud/cloud.hpp"
#include "tests/perception/cloud/real_clouds.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

std::vector<LidarPoint> random_points(int count, double reach, std::uint64_t seed) {
  RandomStream random(seed, "clusters");
  std::vector<LidarPoint> points(static_cast<std::size_t>(count));
  for (LidarPoint& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      point.position[axis] = static_cast<float>(random.uniform(-reach, reach));
    }
  }
  return points;
}

// Labels by spreading from point to point.
std::vector<int> brute_force(const std::vector<LidarPoint>& points, float tolerance) {
  std::vector<int> label(points.size(), -1);
  int next = 0;
  for (std::size_t seed = 0; seed < points.size(); ++seed) {
    if (label[seed] >= 0) continue;
    std::vector<std::size_t> open{seed};
    label[seed] = next;
    while (!open.empty()) {
      const std::size_t from = open.back();
      open.pop_back();
      for (std::size_t to = 0; to < points.size(); ++to) {
        const float far2 = (points[from].position - points[to].position).squaredNorm();
        if (label[to] >= 0 || far2 > tolerance * tolerance) continue;
        label[to] = next;
        open.push_back(to);
      }
    }
    ++next;
  }
  return label;
}

TEST(Clusters, AreThoseOfABruteForceSearch) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    // From scattered single points to one cluster of all.
    const auto points = random_points(300, 1.0 + 0.1 * static_cast<double>(seed), seed);
    ClusterConfig config;
    config.least_points_count = 1;
    ClusterFinder finder(config);
    const auto clusters = finder.find(points);
    const std::vector<int> expected = brute_force(points, 0.5f);
    const std::set<int> labels(expected.begin(), expected.end());
    ASSERT_EQ(static_cast<std::size_t>(std::ssize(clusters)), labels.size()) << seed;
    std::size_t members = 0;
    for (const Cluster& cluster : clusters) {
      const int label = expected[static_cast<std::size_t>(cluster.indices[0])];
      for (const int index : cluster.indices) {
        ASSERT_EQ(expected[static_cast<std::size_t>(index)], label);
      }
      members += cluster.indices.size();
    }
    EXPECT_EQ(members, points.size());
  }
}

TEST(Clusters, HaveCentroidAndExtentLargestFirst) {
  std::vector<LidarPoint> points;
  for (int i = 0; i < 10; ++i) points.push_back({{0.1f * static_cast<float>(i), 5, 1}, 0, 0, 0});
  for (int i = 0; i < 20; ++i) points.push_back({{0.1f * static_cast<float>(i), -5, 1}, 0, 0, 0});
  points.push_back({{20, 20, 20}, 0, 0, 0});
  ClusterFinder finder;
  const auto clusters = finder.find(points);
  ASSERT_EQ(clusters.size(), 2u) << "a single point is none";
  EXPECT_EQ(clusters[0].count(), 20);
  EXPECT_LT((clusters[0].centroid - Eigen::Vector3f(0.95f, -5, 1)).norm(), 1e-5f);
  EXPECT_LT((clusters[0].low - Eigen::Vector3f(0, -5, 1)).norm(), 1e-5f);
  EXPECT_LT((clusters[0].high - Eigen::Vector3f(1.9f, -5, 1)).norm(), 1e-5f);
  EXPECT_EQ(clusters[1].indices[0], 0);
  EXPECT_TRUE(std::is_sorted(clusters[0].indices.begin(), clusters[0].indices.end()));
}

TEST(Clusters, TooSmallAndTooLargeAreLeftOut) {
  const auto points = random_points(200, 0.2, 1);
  ClusterConfig config;
  config.most_points_count = 199;
  EXPECT_TRUE(ClusterFinder(config).find(points).empty());
  config.most_points_count = 200;
  EXPECT_EQ(ClusterFinder(config).find(points).size(), 1u);
  config.least_points_count = 201;
  EXPECT_TRUE(ClusterFinder(config).find(points).empty());
}

TEST(Clusters, OnlyObjectsAreClusteredWhereLabelsSaySo) {
  const auto points = random_points(200, 0.2, 1);
  std::vector<GroundLabel> labels(points.size(), GroundLabel::kGround);
  for (std::size_t i = 0; i < 50; ++i) labels[2 * i] = GroundLabel::kObject;
  ClusterFinder finder;
  const auto clusters = finder.find(points, labels);
  ASSERT_EQ(clusters.size(), 1u);
  ASSERT_EQ(clusters[0].count(), 50);
  for (const int index : clusters[0].indices) EXPECT_EQ(index % 2, 0);
}

TEST(Clusters, BadInputHasNone) {
  ClusterFinder finder;
  EXPECT_TRUE(finder.find({}).empty());
  std::vector<LidarPoint> points(20);
  for (LidarPoint& point : points) point.position = {0, std::nanf(""), 0};
  EXPECT_TRUE(finder.find(points).empty());
  for (LidarPoint& point : points) point.position = {0, 0, 1e9f};
  EXPECT_TRUE(finder.find(points).empty());
  for (LidarPoint& point : points) point.position = {1, 1, 1};
  EXPECT_EQ(finder.find(points).size(), 1u) << "all at one place";
}

TEST(Clusters, DoNotAllocateOnceWarm) {
  const auto points = random_points(3000, 5.0, 2);
  ClusterFinder finder;
  const std::size_t count = finder.find(points).size();
  const long before = testing::allocation_count();
  EXPECT_EQ(finder.find(points).size(), count);
  EXPECT_EQ(testing::allocation_count(), before);
}

// KITTI object 000000: the pedestrian, 8.4 m ahead and 1.9 m to the right (label_2), is a cluster
// of its own.
TEST(Clusters, ThePedestrianOfKittiIsOne) {
  const auto file = real_cloud("kitti_000000/velodyne_000000.bin");
  if (!file) GTEST_SKIP() << "no data";
  const auto scan = load_cloud(*file);
  ASSERT_TRUE(scan);
  SensorMount mount;
  mount.z_m = 1.73;
  std::vector<LidarPoint> points;
  crop_to_base(scan->points, mount.pose(), CropConfig{}, points);
  HeightGrid ground;
  ground.update(points, {0.0, 0.0});
  ClusterFinder finder;
  int found = 0;
  for (const Cluster& cluster : finder.find(points, ground.labels())) {
    const Eigen::Vector2f off = cluster.centroid.head<2>() - Eigen::Vector2f(8.7f, -1.85f);
    if (off.norm() > 0.5f) continue;
    ++found;
    EXPECT_GT(cluster.count(), 250);
    const Eigen::Vector3f size = cluster.high - cluster.low;
    EXPECT_NEAR(size.z(), 1.75, 0.25) << "labelled 1.89 m high";
    EXPECT_LT(size.head<2>().maxCoeff(), 1.3f) << "labelled 1.20 m long";
  }
  EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace headland
