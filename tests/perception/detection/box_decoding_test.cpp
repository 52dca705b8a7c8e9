// SPDX-License-Identifier: Apache-2.0
#include "perception/detection/box_decoding.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

const std::vector<ObjectClass> kClasses = {ObjectClass::kPerson, ObjectClass::kVehicle,
                                           ObjectClass::kLivestock, ObjectClass::kLivestock};

TEST(DecodeSsd, ScalesBoxesToTheImage) {
  const std::vector<float> values = {0, 0, 0.9f, 0.25f, 0.5f, 0.5f, 1.0f,
                                     0, 2, 0.1f, 0.0f,  0.0f, 1.0f, 1.0f};
  const auto boxes = decode_ssd({values, 7}, kClasses, stretched(400, 200), {});
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_NEAR(boxes[0].box.left, 100.0, 1e-4);
  EXPECT_NEAR(boxes[0].box.top, 100.0, 1e-4);
  EXPECT_NEAR(boxes[0].box.right, 200.0, 1e-4);
  EXPECT_NEAR(boxes[0].box.bottom, 200.0, 1e-4);
  EXPECT_NEAR(boxes[0].score, 0.9, 1e-6);
  EXPECT_GT(boxes[0].probability[0], 0.9);
}

TEST(DecodeSsd, ClassesBeyondThoseGivenAreLeftOut) {
  const std::vector<float> values = {0, 9,  0.9f, 0.1f, 0.1f, 0.5f, 0.5f,
                                     0, -1, 0.9f, 0.1f, 0.1f, 0.5f, 0.5f};
  EXPECT_TRUE(decode_ssd({values, 7}, kClasses, stretched(400, 200), {}).empty());
}

TEST(DecodeDarknet, TakesTheBestOfEachClass) {
  // Horse and cow at once are livestock, and sure.
  const std::vector<float> values = {0.5f, 0.5f, 0.2f, 0.4f, 0.8f, 0.05f, 0.0f, 0.4f, 0.7f};
  const auto boxes = decode_darknet({values, 9}, kClasses, stretched(1000, 500), {});
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_NEAR(boxes[0].box.left, 400.0, 1e-3);
  EXPECT_NEAR(boxes[0].box.bottom, 350.0, 1e-3);
  EXPECT_NEAR(boxes[0].score, 0.7, 1e-6);
  EXPECT_GT(boxes[0].probability[1], 0.8);
  EXPECT_NEAR(std::accumulate(boxes[0].probability.begin(), boxes[0].probability.end(), 0.0), 1.0,
              1e-12);
}

TEST(DecodeYoloV5, MultipliesByObjectnessAndUndoesTheLetterbox) {
  // 1280 x 640 in a square of 640: half the size, 160 rows of border above.
  const InputMapping mapping = letterboxed(1280, 640, 640);
  const std::vector<float> values = {320.0f, 320.0f, 64.0f, 32.0f, 0.5f, 0.8f, 0.0f, 0.0f, 0.0f};
  const auto boxes = decode_yolo_v5({values, 9}, kClasses, mapping, {});
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_NEAR(boxes[0].score, 0.4, 1e-6);
  EXPECT_NEAR(boxes[0].box.left, 640.0 - 64.0, 1e-6);
  EXPECT_NEAR(boxes[0].box.right, 640.0 + 64.0, 1e-6);
  EXPECT_NEAR(boxes[0].box.top, 320.0 - 32.0, 1e-6);
  EXPECT_NEAR(boxes[0].box.bottom, 320.0 + 32.0, 1e-6);
}

TEST(BoxDecoding, ClipsToTheImageAndLeavesOutWhatLiesOffIt) {
  const std::vector<float> values = {0.0f, 0.0f, 0.5f, 0.5f, 1.0f, 0.9f, 0.0f, 0.0f, 0.0f,
                                     3.0f, 3.0f, 0.5f, 0.5f, 1.0f, 0.9f, 0.0f, 0.0f, 0.0f};
  const auto boxes = decode_darknet({values, 9}, kClasses, stretched(100, 100), {});
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_EQ(boxes[0].box.left, 0.0);
  EXPECT_NEAR(boxes[0].box.right, 25.0, 1e-6);
}

TEST(BoxDecoding, BadRowsAreLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values = {nan,  0.5f, 0.2f, 0.4f, 0.8f, 0.9f,
                                     0.0f, 0.0f, 0.0f, 0.5f, 0.5f, 0.2f};
  EXPECT_TRUE(decode_darknet({values, 9}, kClasses, stretched(100, 100), {}).empty());
  EXPECT_TRUE(decode_darknet({values, 3}, kClasses, stretched(100, 100), {}).empty());
  EXPECT_TRUE(decode_darknet({{}, 9}, kClasses, stretched(100, 100), {}).empty());
  EXPECT_TRUE(decode_ssd({values, 0}, kClasses, stretched(100, 100), {}).empty());
  EXPECT_TRUE(decode_yolo_v5({values, 9}, {}, stretched(100, 100), {}).empty());
}

TEST(BoxDecoding, SurvivesAnyNumbers) {
  RandomStream random(1, "box_decoding");
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<float> values(63);
    for (float& v : values) v = static_cast<float>(random.uniform(-3.0, 3.0) * 1e3);
    for (const auto& boxes : {decode_ssd({values, 7}, kClasses, stretched(64, 48), {}),
                              decode_darknet({values, 9}, kClasses, stretched(64, 48), {}),
                              decode_yolo_v5({values, 9}, kClasses, letterboxed(64, 48, 32), {})}) {
      for (const DetectedBox& found : boxes) {
        EXPECT_GE(found.box.left, 0.0);
        EXPECT_LE(found.box.right, 64.0);
        EXPECT_LE(found.box.bottom, 48.0);
        EXPECT_LE(found.score, 1.0);
        EXPECT_GT(found.box.area(), 0.0);
      }
    }
  }
}

TEST(SuppressDoubles, KeepsTheSurestOfThoseOfOneClass) {
  const ClassProbability person = {0.9, 0.05, 0.03, 0.02};
  const ClassProbability animal = {0.05, 0.9, 0.03, 0.02};
  const std::vector<DetectedBox> boxes = {{{0.0, 0.0, 10.0, 10.0}, 0.5, person},
                                          {{0.0, 0.0, 10.0, 11.0}, 0.9, person},
                                          {{0.0, 0.0, 10.0, 10.0}, 0.6, animal},
                                          {{20.0, 0.0, 30.0, 10.0}, 0.4, person}};
  const auto kept = suppress_doubles(boxes, 0.45);
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_EQ(kept[0].score, 0.9);
  EXPECT_EQ(kept[1].score, 0.6);
  EXPECT_EQ(kept[2].score, 0.4);
  EXPECT_EQ(suppress_doubles(kept, 0.45).size(), 3u);
  EXPECT_TRUE(suppress_doubles({}, 0.45).empty());
}

}  // namespace
}  // namespace headland
