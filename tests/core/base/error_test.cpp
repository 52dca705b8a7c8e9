// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

TEST(Error, OneLineNamesPlaceCauseAndRemedy) {
  const Error error{ErrorCode::kOutOfRange, "0 is out of range", "must be greater than 0",
                    {"farm.geojson", 12, "features.3.properties.row_spacing_m"}};
  EXPECT_EQ(to_string(error),
            "farm.geojson:12: features.3.properties.row_spacing_m: 0 is out of range; must be greater "
            "than 0 [E106]");
}

TEST(Error, UnknownPartsAreLeftOut) {
  EXPECT_EQ(to_string({ErrorCode::kNoPath, "no way", "", {}}), "no way [E202]");
  EXPECT_EQ(to_string({ErrorCode::kFileNotFound, "no such file", "", {"a.yaml", 0, ""}}),
            "a.yaml: no such file [E101]");
}

TEST(Error, ExitCodeFollowsTheNumber) {
  EXPECT_EQ(exit_code(ErrorCode::kSyntax), 2);
  EXPECT_EQ(exit_code(ErrorCode::kUnsupported), 2);
  EXPECT_EQ(exit_code(ErrorCode::kEnergyInfeasible), 3);
  EXPECT_EQ(exit_code(ErrorCode::kPathLost), 4);
  EXPECT_EQ(exit_code(ErrorCode::kInternal), 4);
}

TEST(ErrorDeathTest, BrokenInvariantTerminatesWithItsPlace) {
  EXPECT_DEATH(HEADLAND_CHECK(1 == 2, "sums"), "internal error: sums .1 == 2. at .*error_test.cpp");
}

}  // namespace
}  // namespace headland
