// SPDX-License-Identifier: Apache-2.0
#include "local_planner/prediction/response_features.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/local_planner/prediction/random_network.hpp"

namespace headland {
namespace {

using Vector = Eigen::Vector2f;

TEST(ResponseFeatures, NothingIsToEvadeWhereThePathsKeepApart) {
  const PairFeatures passes = pair_features({4.0F, 2.5F}, {-1.0F, 0.0F}, 2.0F);
  EXPECT_EQ(passes(6), 0.0F);
  EXPECT_EQ(passes(7), 0.0F);
  EXPECT_EQ(passes(9), 0.0F);
  const PairFeatures leaves = pair_features({4.0F, 0.0F}, {1.0F, 0.0F}, 2.0F);
  EXPECT_EQ(leaves(9), 0.0F);
  EXPECT_EQ(leaves(8), 0.0F);
}

TEST(ResponseFeatures, TheEvasionPointsAwayFromWhereTheOtherPasses) {
  // The other comes head on and passes 0.5 m to the left in 3 s; 2 m are wanted.
  const PairFeatures f = pair_features({3.0F, 0.5F}, {-1.0F, 0.0F}, 2.0F);
  EXPECT_NEAR(f(9), 1.5F, 1e-2);           // that deep inside
  EXPECT_NEAR(f(8), 3.0F / 4.0F, 1e-2);    // when
  EXPECT_NEAR(f(6), 0.0F, 0.03);           // sideways,
  EXPECT_NEAR(f(7), -1.5F / 3.4F, 0.06F);  // to the right
}

TEST(ResponseFeatures, FeaturesAreFiniteAndBoundedAtContactAndAtTheSamePlace) {
  for (const Vector& offset : {Vector(0.0F, 0.0F), Vector(1e-20F, 0.0F), Vector(0.3F, -0.2F)}) {
    for (const Vector& velocity : {Vector(0.0F, 0.0F), Vector(60.0F, -60.0F)}) {
      const PairFeatures f = pair_features(offset, velocity, 3.0F);
      EXPECT_TRUE(f.allFinite());
      EXPECT_LE(f.segment<2>(4).norm(), 2.0F);
      EXPECT_LE(f.segment<2>(6).norm(), 2.001F);
      EXPECT_LE(f(9), 2.0F);
    }
  }
}

TEST(ResponseFeatures, WhatIsSeenFadesTowardsTheBorderOfSight) {
  EXPECT_EQ(visibility(0.0F, 6.0F), 1.0F);
  EXPECT_EQ(visibility(4.0F, 6.0F), 1.0F);
  EXPECT_EQ(visibility(5.0F, 6.0F), 0.5F);
  EXPECT_EQ(visibility(6.0F, 6.0F), 0.0F);
  EXPECT_EQ(visibility(1e30F, 6.0F), 0.0F);
  EXPECT_FALSE(visibility(std::numeric_limits<float>::quiet_NaN(), 6.0F) > 0.0F);
}

CrowdMoment moment_of(const std::vector<Vector>& positions) {
  CrowdMoment moment;
  moment.position = positions;
  moment.velocity.assign(positions.size(), Vector(1.0F, 0.0F));
  moment.present.assign(positions.size(), 1);
  moment.robot = {100.0F, 100.0F};
  return moment;
}

Eigen::MatrixXf inputs_of(const ResponseNetwork& network, const CrowdMoment& moment) {
  const std::vector<CrowdMember> members(moment.position.size());
  Eigen::MatrixXf stacked(network.encoder.inputs(), static_cast<Eigen::Index>(members.size()));
  ResponseInputs().compute(network, members, moment, 1.5F, stacked);
  return stacked;
}

TEST(ResponseFeatures, OfManyNeighboursTheMostCountsInAnyOrder) {
  const ResponseNetwork network = testing::random_network(1);
  const Vector self(0.0F, 0.0F), a(2.0F, 1.0F), b(-1.0F, 2.0F);
  const Eigen::VectorXf both = inputs_of(network, moment_of({self, a, b})).col(0);
  const Eigen::VectorXf swapped = inputs_of(network, moment_of({self, b, a})).col(0);
  const Eigen::VectorXf only_a = inputs_of(network, moment_of({self, a})).col(0);
  const Eigen::VectorXf only_b = inputs_of(network, moment_of({self, b})).col(0);
  EXPECT_LT((both - swapped).norm(), 1e-6);
  EXPECT_LT((both - only_a.cwiseMax(only_b)).norm(), 1e-6);
  EXPECT_GT((only_a - only_b).norm(), 0.1);
}

TEST(ResponseFeatures, AbsentAgentsAreNotSeenAndSeeNothing) {
  const ResponseNetwork network = testing::random_network(2);
  CrowdMoment moment = moment_of({{0.0F, 0.0F}, {1.0F, 1.0F}});
  moment.present[1] = 0;
  const Eigen::MatrixXf inputs = inputs_of(network, moment);
  EXPECT_TRUE(inputs.col(1).isZero(0.0F));
  EXPECT_EQ(inputs.col(0), inputs_of(network, moment_of({{0.0F, 0.0F}})).col(0));
}

}  // namespace
}  // namespace headland
