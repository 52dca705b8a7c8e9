// SPDX-License-Identifier: Apache-2.0
#include "perception/detection/opencv_detector.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "perception/detection/association.hpp"

namespace headland {
namespace {

namespace fs = std::filesystem;

fs::path data() {
  const char* given = std::getenv("HEADLAND_DATA");
  return given != nullptr ? fs::path(given) : fs::path(HEADLAND_SOURCE_DIR) / "../shared/data";
}

NetworkConfig yolo_fastest() {
  NetworkConfig config;
  config.weights = (data() / "models/yolo-fastest-1.1.weights").string();
  config.layers = (data() / "models/yolo-fastest-1.1.cfg").string();
  config.names = (data() / "models/coco.names").string();
  return config;
}

bool has_opencv() {
  const auto detector = make_opencv_detector({});
  return detector || detector.error().code != ErrorCode::kUnsupported;
}

int count_of(const std::vector<DetectedBox>& boxes, ObjectClass object) {
  return static_cast<int>(std::count_if(boxes.begin(), boxes.end(), [&](const DetectedBox& box) {
    return box.probability[static_cast<std::size_t>(object)] > 0.5;
  }));
}

class NoNetwork : public Detector {
 private:
  Result<std::vector<DetectedBox>> do_detect(const Image&) override {
    return std::vector<DetectedBox>{};
  }
};

TEST(Detector, RefusesImagesThatAreNotAsLargeAsTheySay) {
  NoNetwork detector;
  EXPECT_FALSE(detector.detect({}));
  EXPECT_FALSE(detector.detect({10, 10, std::vector<std::uint8_t>(299)}));
  EXPECT_FALSE(detector.detect({-1, -1, std::vector<std::uint8_t>(3)}));
  EXPECT_TRUE(detector.detect({10, 10, std::vector<std::uint8_t>(300)}));
}

TEST(OpencvDetector, SaysWhatItLacks) {
  const auto detector = make_opencv_detector(yolo_fastest());
  if (!has_opencv()) {
    ASSERT_FALSE(detector);
    EXPECT_EQ(detector.error().code, ErrorCode::kUnsupported);
    EXPECT_EQ(read_image("any.jpg").error().code, ErrorCode::kUnsupported);
    return;
  }
  NetworkConfig config = yolo_fastest();
  config.weights = "no_such_file.weights";
  EXPECT_EQ(make_opencv_detector(config).error().code, ErrorCode::kFileNotFound);
  EXPECT_EQ(read_image("no_such_file.jpg").error().code, ErrorCode::kFileNotFound);
}

TEST(OpencvDetector, RefusesFilesThatAreNoNetwork) {
  if (!has_opencv()) GTEST_SKIP() << "built without OpenCV";
  const fs::path folder = fs::temp_directory_path() / "headland_no_network";
  fs::create_directories(folder);
  const std::string file = (folder / "broken.cfg").string();
  std::ofstream(file) << "person\n";
  NetworkConfig config;
  config.weights = file;
  config.layers = file;
  config.names = file;
  EXPECT_EQ(make_opencv_detector(config).error().code, ErrorCode::kSyntax);
  EXPECT_EQ(read_image(file).error().code, ErrorCode::kSyntax);
  fs::remove_all(folder);
}

TEST(OpencvDetector, FindsPeopleAndAnimals) {
  if (!has_opencv()) GTEST_SKIP() << "built without OpenCV";
  if (!fs::exists(yolo_fastest().weights)) GTEST_SKIP() << "no " << yolo_fastest().weights;
  const auto detector = make_opencv_detector(yolo_fastest());
  ASSERT_TRUE(detector);
  const auto boxes_on = [&](const std::string& name) {
    const auto image = read_image((data() / name).string());
    EXPECT_TRUE(image) << name;
    return (*detector)->detect(*image).value();
  };
  EXPECT_GE(count_of(boxes_on("camera/darknet_person.jpg"), ObjectClass::kPerson), 1);
  EXPECT_GE(count_of(boxes_on("camera/darknet_horses.jpg"), ObjectClass::kLivestock), 3);
  const auto dog = boxes_on("camera/darknet_dog.jpg");
  EXPECT_GE(count_of(dog, ObjectClass::kLivestock), 1);
  EXPECT_GE(count_of(dog, ObjectClass::kVehicle), 1);
  const auto row = boxes_on("camera/vineyard_june_sample_eligible_cor0_f9668.jpg");
  EXPECT_EQ(count_of(row, ObjectClass::kPerson), 0);
  EXPECT_EQ(count_of(row, ObjectClass::kLivestock), 0);
}

TEST(OpencvDetector, FindsThePedestrianOfKitti) {
  if (!has_opencv()) GTEST_SKIP() << "built without OpenCV";
  if (!fs::exists(yolo_fastest().weights)) GTEST_SKIP() << "no " << yolo_fastest().weights;
  const auto detector = make_opencv_detector(yolo_fastest());
  ASSERT_TRUE(detector);
  const auto image = read_image((data() / "lidar/kitti_000000/image_2_000000.png").string());
  ASSERT_TRUE(image);
  const auto boxes = (*detector)->detect(*image);
  ASSERT_TRUE(boxes);
  double best = 0.0;
  for (const DetectedBox& box : *boxes) {
    if (box.probability[0] < 0.5) continue;
    best = std::max(best, box_overlap(box.box, {712.40, 143.00, 810.73, 307.92}));
  }
  EXPECT_GE(best, 0.7);
}

}  // namespace
}  // namespace headland
