// SPDX-License-Identifier: Apache-2.0
#include "core/config/messages.hpp"

#include <gtest/gtest.h>

namespace headland::config {
namespace {

TEST(Messages, RangesAreToldInWords) {
  EXPECT_EQ(allowed(kPositive), "must be greater than 0");
  EXPECT_EQ(allowed(kNonNegative), "must be at least 0");
  EXPECT_EQ(allowed(kFraction), "allowed: 0 to 1");
  EXPECT_EQ(allowed({.max = 5.0}), "must be at most 5");
}

TEST(Messages, ANearNameIsSuggestedAndElseAllAreListed) {
  EXPECT_EQ(suggestion("row_spacng_m", {"id", "row_spacing_m"}), "did you mean 'row_spacing_m'?");
  EXPECT_EQ(suggestion("colour", {"id", "row_spacing_m"}), "allowed: id, row_spacing_m");
}

}  // namespace
}  // namespace headland::config
