// SPDX-License-Identifier: Apache-2.0
#include "sim/crowd/sight.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace headland {
namespace {

TEST(Sight, WhoIsFarIsNotSeenAndNoiseGrowsWithDistance) {
  std::vector<Agent> agents(3);
  agents[0].position = {2.0, 0.0};
  agents[1].position = {0.0, 10.0};
  agents[2].position = {30.0, 0.0};
  for (int i = 0; i < 3; ++i) agents[static_cast<std::size_t>(i)].id = i;
  RandomStream noise(1, "test/sight");
  std::vector<Agent> seen;
  double near2 = 0.0;
  double far2 = 0.0;
  constexpr int kTimes = 4000;
  for (int k = 0; k < kTimes; ++k) {
    see_agents(agents, {0.0, 0.0}, 20.0, 0.02, noise, seen);
    ASSERT_EQ(seen.size(), 2u);
    near2 += (seen[0].position - agents[0].position).squaredNorm() / 2.0;
    far2 += (seen[1].position - agents[1].position).squaredNorm() / 2.0;
  }
  EXPECT_EQ(seen[1].id, 1);
  EXPECT_NEAR(std::sqrt(near2 / kTimes), 0.04, 0.002);
  EXPECT_NEAR(std::sqrt(far2 / kTimes), 0.2, 0.01);
  EXPECT_NEAR(seen[0].noise_m, 0.04, 1e-12);
  EXPECT_NEAR(seen[1].noise_m, 0.2, 1e-12);
}

TEST(Sight, WithoutNoiseAgentsAreWhereTheyAre) {
  std::vector<Agent> agents(1);
  agents[0].position = {2.0, 3.0};
  RandomStream noise(1, "test/sight");
  std::vector<Agent> seen(7);
  see_agents(agents, {0.0, 0.0}, 20.0, 0.0, noise, seen);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].position, agents[0].position);
  EXPECT_GT(seen[0].noise_m, 0.0);
}

}  // namespace
}  // namespace headland
