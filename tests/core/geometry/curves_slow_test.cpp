// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/geometry/dubins.hpp"
#include "core/geometry/reeds_shepp.hpp"
#include "tests/support/dubins_oracle.hpp"
#include "tests/support/steering_curves.hpp"

namespace headland {
namespace {

TEST(DubinsSlow, IsNeverLongerThan200000ConstructedCurves) {
  test::expect_never_longer_than_constructions(200000, "slow", test::random_forward_construction,
                                               shortest_dubins, dubins_length);
}

TEST(DubinsSlow, AgreesWithASearchOverFirstTurnsInALargeSample) {
  RandomStream random(5, "dubins slow");
  for (int i = 0; i < 2000; ++i) {
    const Pose2 from = test::random_pose(random, i % 2 == 0 ? 10.0 : 3.0);
    const Pose2 to = test::random_pose(random, i % 2 == 0 ? 10.0 : 3.0);
    ASSERT_NEAR(dubins_length(from, to, 2.0), test::DubinsOracle(from, to, 2.0).length(), 1e-7)
        << i;
  }
}

TEST(ReedsSheppSlow, IsNeverLongerThan200000ConstructedCurves) {
  test::expect_never_longer_than_constructions(200000, "slow", test::random_reversing_construction,
                                               shortest_reeds_shepp, reeds_shepp_length);
}

}  // namespace
}  // namespace headland
