// SPDX-License-Identifier: Apache-2.0
#include "perception/detection/association.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace headland {
namespace {

namespace fs = std::filesystem;

// 640 x 480 pixels, looking ahead, 1 m up.
CameraModel camera_ahead() {
  CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  Eigen::Matrix3d intrinsics;
  intrinsics << 500.0, 0.0, 320.0, 0.0, 500.0, 240.0, 0.0, 0.0, 1.0;
  Eigen::Matrix<double, 3, 4> T_camera_base;
  T_camera_base << 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 1.0, 1.0, 0.0, 0.0, 0.0;
  camera.projection = intrinsics * T_camera_base;
  return camera;
}

using Points = std::vector<Eigen::Vector3f>;

Points body_at(float x, float y, float width, float height) {
  Points points;
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 20; ++j) {
      points.emplace_back(x, y + width * (static_cast<float>(i) / 20.0f - 0.5f),
                          height * static_cast<float>(j) / 20.0f);
    }
  }
  return points;
}

DetectedBox person_on(const ImageBox& box, double score = 0.9) {
  return {box, score, {0.9, 0.04, 0.03, 0.03}};
}

TEST(BoxOverlap, IsSymmetricAndFromNoneToAll) {
  const ImageBox a{0.0, 0.0, 10.0, 10.0};
  const ImageBox b{5.0, 0.0, 15.0, 10.0};
  EXPECT_NEAR(box_overlap(a, b), 1.0 / 3.0, 1e-12);
  EXPECT_EQ(box_overlap(a, b), box_overlap(b, a));
  EXPECT_EQ(box_overlap(a, a), 1.0);
  EXPECT_EQ(box_overlap(a, {20.0, 0.0, 30.0, 10.0}), 0.0);
  EXPECT_EQ(box_overlap({}, {}), 0.0);
}

TEST(ProjectCluster, GivesTheBoxThatItsBodyHas) {
  const auto cluster = project_cluster(body_at(10.0f, 0.0f, 0.6f, 1.8f), camera_ahead(), {});
  ASSERT_TRUE(cluster);
  EXPECT_NEAR(cluster->box.left, 305.0, 2.0);
  EXPECT_NEAR(cluster->box.right, 335.0, 2.0);
  EXPECT_NEAR(cluster->box.top, 200.0, 5.0);
  EXPECT_NEAR(cluster->box.bottom, 290.0, 5.0);
  EXPECT_NEAR(cluster->depth_m, 10.0, 0.1);
}

TEST(ProjectCluster, IsNotStretchedByStrayPointsAndNoNumbers) {
  Points points = body_at(10.0f, 0.0f, 0.6f, 1.8f);
  const auto clean = project_cluster(points, camera_ahead(), {});
  points.emplace_back(10.0f, 5.0f, 3.0f);
  points.emplace_back(-10.0f, 0.0f, 1.0f);
  points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0f, 1.0f);
  const auto cluster = project_cluster(points, camera_ahead(), {});
  ASSERT_TRUE(cluster);
  EXPECT_GT(box_overlap(cluster->box, clean->box), 0.9);
}

TEST(ProjectCluster, IsClippedToTheImageAndNoneOffIt) {
  const auto near_one = project_cluster(body_at(1.0f, 0.4f, 1.5f, 3.0f), camera_ahead(), {});
  ASSERT_TRUE(near_one);
  EXPECT_GE(near_one->box.left, 0.0);
  EXPECT_LE(near_one->box.bottom, 480.0);
  EXPECT_FALSE(project_cluster(body_at(-10.0f, 0.0f, 0.6f, 1.8f), camera_ahead(), {}));
  EXPECT_FALSE(project_cluster(body_at(5.0f, 30.0f, 0.6f, 1.8f), camera_ahead(), {}));
  EXPECT_FALSE(project_cluster({}, camera_ahead(), {}));
}

TEST(AssociateBoxes, PairsEachWithItsOwn) {
  const AssociationConfig config;
  std::vector<std::optional<ClusterBox>> clusters;
  std::vector<DetectedBox> boxes;
  for (const float y : {-2.0f, 0.0f, 2.0f}) {
    clusters.push_back(project_cluster(body_at(10.0f, y, 0.6f, 1.8f), camera_ahead(), config));
    ImageBox box = clusters.back()->box;
    box.left -= 4.0;
    box.top -= 5.0;
    boxes.insert(boxes.begin(), person_on(box));
  }
  clusters.push_back(std::nullopt);
  const Association association = associate_boxes(clusters, boxes, config);
  EXPECT_EQ(association.box_of, (std::vector<int>{2, 1, 0, -1}));
  EXPECT_GT(association.probability[0][0], 0.6);
  EXPECT_EQ(association.probability[3], (ClassProbability{0.25, 0.25, 0.25, 0.25}));
  for (const ClassProbability& p : association.probability) {
    EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-12);
  }
}

TEST(AssociateBoxes, OneBoxIsOfOneClusterAlone) {
  const ClusterBox cluster{{100.0, 100.0, 140.0, 200.0}, 10.0, 50};
  const ClusterBox beside{{110.0, 100.0, 150.0, 200.0}, 9.9, 50};
  AssociationConfig config;
  config.depth_order_ratio = 1.0;
  const std::optional<ClusterBox> clusters[] = {cluster, beside};
  const DetectedBox boxes[] = {person_on(cluster.box)};
  const Association association = associate_boxes(clusters, boxes, config);
  EXPECT_EQ(association.box_of, (std::vector<int>{0, -1}));
}

TEST(AssociateBoxes, WhatIsBehindDoesNotGetTheBoxOfWhatIsInFront) {
  const std::optional<ClusterBox> clusters[] = {ClusterBox{{98.0, 98.0, 142.0, 200.0}, 20.0, 50},
                                                ClusterBox{{100.0, 100.0, 136.0, 190.0}, 8.0, 50}};
  const DetectedBox boxes[] = {person_on({98.0, 98.0, 142.0, 200.0})};
  EXPECT_EQ(associate_boxes(clusters, boxes, {}).box_of, (std::vector<int>{-1, 0}));
}

TEST(AssociateBoxes, FarBoxesUnsureOnesAndNoNumbersAreNobodys) {
  const std::optional<ClusterBox> clusters[] = {ClusterBox{{100.0, 100.0, 140.0, 200.0}, 10.0, 50}};
  const double nan = std::nan("");
  const DetectedBox boxes[] = {
      person_on({300.0, 100.0, 340.0, 200.0}), person_on({100.0, 100.0, 140.0, 200.0}, 0.1),
      person_on({nan, 100.0, 140.0, 200.0}), person_on({100.0, 100.0, 140.0, 200.0}, nan)};
  EXPECT_EQ(associate_boxes(clusters, boxes, {}).box_of, (std::vector<int>{-1}));
  EXPECT_TRUE(associate_boxes({}, boxes, {}).box_of.empty());
  EXPECT_EQ(associate_boxes(clusters, {}, {}).box_of, (std::vector<int>{-1}));
}

// KITTI object frame 000000: a pedestrian at 8.4 m.

fs::path kitti() {
  const char* given = std::getenv("HEADLAND_DATA");
  const fs::path root =
      given != nullptr ? fs::path(given) : fs::path(HEADLAND_SOURCE_DIR) / "../shared/data";
  return root / "lidar/kitti_000000";
}

// The numbers of the line that begins with `key`.
std::vector<double> numbers_of(const fs::path& file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key)) continue;
    std::istringstream words(line.substr(key.size()));
    std::vector<double> numbers;
    for (double number = 0.0; words >> number;) numbers.push_back(number);
    return numbers;
  }
  return {};
}

CameraModel kitti_camera() {
  const fs::path file = kitti() / "calib_000000.txt";
  const std::vector<double> p = numbers_of(file, "P2:");
  const std::vector<double> r = numbers_of(file, "R0_rect:");
  const std::vector<double> t = numbers_of(file, "Tr_velo_to_cam:");
  Eigen::Matrix4d rectified = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d from_lidar = Eigen::Matrix4d::Identity();
  rectified.topLeftCorner<3, 3>() =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data());
  from_lidar.topRows<3>() =
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(t.data());
  CameraModel camera;
  camera.width_px = 1224;
  camera.height_px = 370;
  camera.projection = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(p.data()) *
                      rectified * from_lidar;
  return camera;
}

// Points above the road within 25 m, joined over cells of 0.2 m that touch.
std::vector<Points> kitti_clusters() {
  std::ifstream in(kitti() / "velodyne_000000.bin", std::ios::binary);
  std::map<std::pair<int, int>, Points> cells;
  for (float v[4]; in.read(reinterpret_cast<char*>(v), sizeof v);) {
    const Eigen::Vector3f p(v[0], v[1], v[2]);
    if (p.z() < -1.5f || p.z() > 1.0f || p.head<2>().norm() > 25.0f || p.x() < 1.0f) continue;
    cells[{static_cast<int>(std::floor(p.x() / 0.2f)), static_cast<int>(std::floor(p.y() / 0.2f))}]
        .push_back(p);
  }
  std::vector<Points> clusters;
  while (!cells.empty()) {
    clusters.emplace_back();
    std::vector<std::pair<int, int>> open = {cells.begin()->first};
    while (!open.empty()) {
      const auto [x, y] = open.back();
      open.pop_back();
      const auto cell = cells.find({x, y});
      if (cell == cells.end()) continue;
      clusters.back().insert(clusters.back().end(), cell->second.begin(), cell->second.end());
      cells.erase(cell);
      for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) open.emplace_back(x + i, y + j);
      }
    }
    if (clusters.back().size() < 30) clusters.pop_back();
  }
  return clusters;
}

TEST(AssociateBoxes, FindsThePedestrianOfKitti) {
  if (!fs::exists(kitti())) GTEST_SKIP() << "no " << kitti();
  const std::vector<double> label = numbers_of(kitti() / "label_2_000000.txt", "Pedestrian");
  ASSERT_GE(label.size(), 7u);
  const DetectedBox boxes[] = {person_on({label[3], label[4], label[5], label[6]})};
  const CameraModel camera = kitti_camera();
  std::vector<std::optional<ClusterBox>> clusters;
  for (const Points& points : kitti_clusters()) {
    clusters.push_back(project_cluster(points, camera, {}));
  }
  const Association association = associate_boxes(clusters, boxes, {});
  int paired = 0;
  double next_best = 0.0;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    if (association.box_of[c] < 0) {
      if (clusters[c]) next_best = std::max(next_best, box_overlap(clusters[c]->box, boxes[0].box));
      continue;
    }
    ++paired;
    EXPECT_GE(association.overlap[c], 0.7);
    EXPECT_NEAR(clusters[c]->depth_m, 8.6, 0.5);
    EXPECT_GT(association.probability[c][0], 0.6);
  }
  EXPECT_EQ(paired, 1);
  EXPECT_LT(next_best, 0.3);
}

}  // namespace
}  // namespace headland
