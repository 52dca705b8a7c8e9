// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace headland {
namespace {

CameraConfig flawless() {
  CameraConfig config;
  config.found_probability = 1.0;
  config.found_half_px = 0;
  config.jitter_ratio = 0.0;
  config.confusion_probability = 0.0;
  config.false_per_image_ratio = 0.0;
  return config;
}

SensorMount mount() {
  SensorMount at;
  at.z_m = 1.2;
  return at;
}

Agent someone(const Point2& position, AgentKind kind = AgentKind::kPerson) {
  Agent agent;
  agent.position = position;
  agent.kind = kind;
  return agent;
}

LidarScene meadow(const std::vector<Agent>& agents) {
  RowLayout layout;
  layout.rows_count = 0;
  LidarScene scene = LidarScene::rows(layout, vineyard(true), 1);
  scene.set_agents(agents);
  return scene;
}

std::vector<DetectedBox> look(CameraSimulator& camera, const LidarScene& scene) {
  std::vector<DetectedBox> boxes;
  camera.detect(scene, Eigen::Isometry3d::Identity(), boxes);
  return boxes;
}

ObjectClass label(const DetectedBox& box) {
  const auto best = std::max_element(box.probability.begin(), box.probability.end());
  return static_cast<ObjectClass>(best - box.probability.begin());
}

TEST(CameraSimulator, ItsModelLooksAlongItsMount) {
  CameraSimulator camera(CameraConfig{}, mount(), 1);
  const auto ahead = camera.model().pixel({10.0, 0.0, 1.2});
  ASSERT_TRUE(ahead);
  EXPECT_LT((*ahead - Eigen::Vector2d(640.0, 360.0)).norm(), 1e-9);
  EXPECT_NEAR(camera.model().pixel({10.0, 10.0, 1.2})->x(), 0.0, 1e-9);  // left, at 45 degrees
  EXPECT_GT(camera.model().pixel({10.0, 0.0, 0.0})->y(), 360.0);         // below
  EXPECT_FALSE(camera.model().pixel({-10.0, 0.0, 1.2}));
}

TEST(CameraSimulator, APersonGetsABoxOfItsSize) {
  CameraSimulator camera(flawless(), mount(), 1);
  const LidarScene scene = meadow({someone({10.0, 2.0})});
  const auto boxes = look(camera, scene);
  ASSERT_EQ(boxes.size(), 1u);
  const ImageBox& box = boxes[0].box;
  EXPECT_NEAR(0.5 * (box.left + box.right), 640.0 - 640.0 * 2.0 / 10.0, 3.0);
  EXPECT_NEAR(box.bottom, 360.0 + 64.0 * 1.2, 4.0);
  EXPECT_NEAR(box.top, 360.0 - 64.0 * 0.5, 5.0);
  EXPECT_NEAR(box.right - box.left, 64.0 * 0.5, 8.0);
  EXPECT_EQ(label(boxes[0]), ObjectClass::kPerson);
  EXPECT_EQ(camera.truth()[0], 0);
  double sum = 0.0;
  for (const double p : boxes[0].probability) sum += p;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(CameraSimulator, AnimalsAreLivestock) {
  CameraSimulator camera(flawless(), mount(), 1);
  const LidarScene scene =
      meadow({someone({8.0, -2.0}, AgentKind::kSheep), someone({8.0, 2.0}, AgentKind::kCattle),
              someone({14.0, 0.0}, AgentKind::kVehicle)});
  const auto boxes = look(camera, scene);
  ASSERT_EQ(boxes.size(), 3u);
  EXPECT_EQ(label(boxes[0]), ObjectClass::kLivestock);
  EXPECT_EQ(label(boxes[1]), ObjectClass::kLivestock);
  EXPECT_EQ(label(boxes[2]), ObjectClass::kVehicle);
}

TEST(CameraSimulator, ThoseBehindOrOutOfViewAreNotSeen) {
  CameraSimulator camera(flawless(), mount(), 1);
  const LidarScene scene =
      meadow({someone({-10.0, 0.0}), someone({5.0, 9.0}), someone({0.0, 0.0})});
  EXPECT_TRUE(look(camera, scene).empty());
}

TEST(CameraSimulator, ThoseBehindOthersAreHidden) {
  CameraSimulator camera(flawless(), mount(), 1);
  const LidarScene scene = meadow({someone({12.0, 0.0}), someone({4.0, 0.0})});
  ASSERT_EQ(look(camera, scene).size(), 1u);
  EXPECT_EQ(camera.truth()[0], 1);
}

TEST(CameraSimulator, LeavesHideAndBareRowsDoNot) {
  CameraSimulator camera(flawless(), mount(), 1);
  const auto found = [&](bool in_leaf) {
    OrchardConfig config = vineyard(in_leaf);
    config.missing_ratio = 0.0;
    if (in_leaf) config.leaf_area_density_1pm = 8.0;
    LidarScene scene = LidarScene::rows({}, config, 1);
    const std::vector<Agent> agents{someone({30.0, 2.5})};  // in the next alley
    scene.set_agents(agents);
    std::vector<DetectedBox> boxes;
    int count = 0;
    for (int i = 0; i < 100; ++i) {
      camera.detect(scene, scene.pose_on_ground({25.0 + 0.01 * i, 0.0, 0.4}), boxes);
      count += static_cast<int>(boxes.size());
    }
    return count;
  };
  EXPECT_GT(found(false), 80);
  EXPECT_LT(found(true), 40);
}

TEST(CameraSimulator, SmallOnesAreMissedMoreOften) {
  CameraConfig config = flawless();
  config.found_probability = 0.9;
  config.found_half_px = 25;
  CameraSimulator camera(config, mount(), 1);
  const auto share = [&](double range) {
    const LidarScene scene = meadow({someone({range, 0.0})});
    int found = 0;
    for (int i = 0; i < 1000; ++i) found += static_cast<int>(look(camera, scene).size());
    return found / 1000.0;
  };
  EXPECT_NEAR(share(6.0), 0.9, 0.03);
  EXPECT_NEAR(share(640.0 * 1.68 / 25.0), 0.45, 0.12);
  EXPECT_LT(share(90.0), 0.2);
}

TEST(CameraSimulator, ClassesAreConfusedAtTheirRate) {
  CameraConfig config = flawless();
  config.confusion_probability = 0.2;
  CameraSimulator camera(config, mount(), 1);
  const LidarScene scene = meadow({someone({8.0, 0.0})});
  int wrong = 0;
  for (int i = 0; i < 2000; ++i) {
    for (const DetectedBox& box : look(camera, scene)) {
      if (label(box) != ObjectClass::kPerson) ++wrong;
    }
  }
  EXPECT_NEAR(wrong, 400, 70);
}

TEST(CameraSimulator, FalseBoxesComeAtTheirRateWithinTheImage) {
  CameraConfig config = flawless();
  config.false_per_image_ratio = 0.5;
  CameraSimulator camera(config, mount(), 1);
  const LidarScene scene = meadow({});
  int count = 0;
  for (int i = 0; i < 2000; ++i) {
    for (const DetectedBox& box : look(camera, scene)) {
      ++count;
      EXPECT_GT(box.box.area(), 0.0);
      EXPECT_GE(box.box.left, 0.0);
      EXPECT_LE(box.box.right, 1280.0);
      EXPECT_EQ(camera.truth()[0], -1);
    }
  }
  EXPECT_NEAR(count, 1000, 120);
}

TEST(CameraSimulator, BoxesJitterAsSaid) {
  CameraConfig config = flawless();
  config.jitter_ratio = 0.05;
  CameraSimulator camera(config, mount(), 1);
  const LidarScene scene = meadow({someone({8.0, 0.0})});
  CameraSimulator exact(flawless(), mount(), 1);
  const ImageBox truth = look(exact, scene)[0].box;
  double squares = 0.0;
  int count = 0;
  for (int i = 0; i < 2000; ++i) {
    for (const DetectedBox& box : look(camera, scene)) {
      squares += std::pow(box.box.top - truth.top, 2);
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.05 * (truth.bottom - truth.top), 0.5);
}

TEST(CameraSimulator, SameSeedSameBoxes) {
  const LidarScene scene = meadow({someone({8.0, 0.0}), someone({15.0, 4.0})});
  CameraSimulator a(CameraConfig{}, mount(), 5);
  CameraSimulator b(CameraConfig{}, mount(), 5);
  for (int i = 0; i < 50; ++i) {
    const auto left = look(a, scene);
    const auto right = look(b, scene);
    ASSERT_EQ(left.size(), right.size());
    for (std::size_t k = 0; k < left.size(); ++k) {
      EXPECT_EQ(left[k].score, right[k].score);
      EXPECT_EQ(left[k].box.top, right[k].box.top);
    }
  }
}

TEST(CameraSimulator, ALostPoseAndLostAgentsGiveNoBox) {
  CameraSimulator camera(flawless(), mount(), 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(look(camera, meadow({someone({nan, 0.0})})).empty());
  Eigen::Isometry3d lost = Eigen::Isometry3d::Identity();
  lost.translation().x() = nan;
  std::vector<DetectedBox> boxes(3);
  camera.detect(meadow({someone({8.0, 0.0})}), lost, boxes);
  EXPECT_TRUE(boxes.empty());
  EXPECT_TRUE(camera.truth().empty());
}

}  // namespace
}  // namespace headland
