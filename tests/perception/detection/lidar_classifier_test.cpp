// SPDX-License-Identifier: Apache-2.0
#include "perception/detection/lidar_classifier.hpp"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "perception/tracking/tracked_agent.hpp"

namespace headland {
namespace {

// A solid body of that size at 10 m.
BodyShape solid(double height, double extent, double speed = 0.0) {
  BodyShape shape{height, extent, speed, 10.0, 0};
  shape.points_count = static_cast<int>(height / 0.35 * extent / 0.035);
  return shape;
}

TEST(ClassifyShape, KnowsTypicalBodies) {
  EXPECT_EQ(most_probable(classify_shape(solid(1.75, 0.55))), ObjectClass::kPerson);
  EXPECT_EQ(most_probable(classify_shape(solid(0.85, 1.1))), ObjectClass::kLivestock);
  EXPECT_EQ(most_probable(classify_shape(solid(1.5, 2.3))), ObjectClass::kLivestock);
  EXPECT_EQ(most_probable(classify_shape(solid(2.6, 4.5))), ObjectClass::kVehicle);
  EXPECT_EQ(most_probable(classify_shape(solid(1.6, 4.0))), ObjectClass::kVehicle);
  EXPECT_EQ(most_probable(classify_shape(solid(3.8, 7.0))), ObjectClass::kOther);
  EXPECT_EQ(most_probable(classify_shape(solid(0.3, 0.2))), ObjectClass::kOther);
}

TEST(ClassifyShape, WhatMovesIsLessLikelyNobody) {
  const BodyShape still = solid(1.9, 0.9);
  const BodyShape moving = solid(1.9, 0.9, 1.2);
  const auto other = static_cast<std::size_t>(ObjectClass::kOther);
  EXPECT_LT(classify_shape(moving)[other], classify_shape(still)[other]);
}

TEST(ClassifyShape, WhatIsThinOfPointsIsLikelierFoliage) {
  BodyShape thin = solid(1.7, 0.6);
  thin.points_count /= 20;
  const auto other = static_cast<std::size_t>(ObjectClass::kOther);
  EXPECT_GT(classify_shape(thin)[other], classify_shape(solid(1.7, 0.6))[other]);
}

TEST(ClassifyShape, FarBodiesAreLessCertain) {
  BodyShape far_one = solid(1.75, 0.55);
  far_one.range_m = 60.0;
  EXPECT_LT(classify_shape(far_one)[0], classify_shape(solid(1.75, 0.55))[0]);
}

TEST(ClassifyShape, IsAlwaysAProbability) {
  for (const double height : {1e-6, 0.5, 2.0, 100.0}) {
    for (const double extent : {1e-6, 0.5, 3.0, 1e6}) {
      const ClassProbability p = classify_shape(solid(height, std::min(extent, 1e3), 0.5));
      EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-9);
      for (const double one : p) EXPECT_GE(one, 0.015);
    }
  }
}

TEST(ClassifyShape, NothingIsUnknown) {
  EXPECT_EQ(classify_shape({}), kUnknownClass);
  BodyShape shape = solid(1.7, 0.5);
  shape.speed_mps = std::nan("");
  EXPECT_EQ(classify_shape(shape), kUnknownClass);
}

}  // namespace
}  // namespace headland
