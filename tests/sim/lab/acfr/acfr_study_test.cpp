// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/acfr_study.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

TEST(AcfrStudy, APlannerOrAnAccuracyThatIsNamedTwiceIsAnError) {
  AcfrStudyConfig planners;
  planners.planners = {LocalPlannerKind::kMcts, LocalPlannerKind::kFailSafe,
                       LocalPlannerKind::kMcts};
  AcfrStudyConfig accuracies;
  accuracies.accuracies_m = {2.0, 1.0, 2.0};
  for (const auto& [config, key] :
       {std::pair(planners, "planners"), std::pair(accuracies, "accuracies_m")}) {
    const auto result = run_acfr_study(config);
    ASSERT_FALSE(result) << key;
    EXPECT_EQ(result.error().code, ErrorCode::kOutOfRange);
    EXPECT_EQ(result.error().where.key, key);
  }
  EXPECT_FALSE(AcfrStudyConfig{}.check());
}

}  // namespace
}  // namespace headland
