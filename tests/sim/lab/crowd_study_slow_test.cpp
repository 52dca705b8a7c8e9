// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/config/yaml.hpp"
#include "sim/lab/crowd_study.hpp"

namespace headland {
namespace {

// The best published method: 98.6 % with people who see the robot. A holonomic ORCA has 94.5 %
// success and 4.2 % collisions where they do not.
TEST(CrowdStudySlow, TreeSearchGetsThroughPeopleWhoSeeItAndWhoDoNot) {
  auto config = config::load<CrowdStudyConfig>("config/studies/crowd.yaml");
  ASSERT_TRUE(config) << to_string(config.error());
  config->planners = {LocalPlannerKind::kMcts};
  config->runs_count = 300;
  const auto result = run_crowd_study(*config, {2});
  ASSERT_TRUE(result) << to_string(result.error());
  const StudyCell* seen = result->find("mcts/visible");
  const StudyCell* unseen = result->find("mcts/invisible");
  ASSERT_TRUE(seen != nullptr && unseen != nullptr);
  EXPECT_GE(seen->find("success")->mean, 0.99);
  EXPECT_EQ(seen->find("collision")->mean, 0.0);
  EXPECT_GE(unseen->find("success")->mean, 0.96);
  EXPECT_LE(unseen->find("collision")->mean, 0.02);
}

}  // namespace
}  // namespace headland
