// SPDX-License-Identifier: Apache-2.0
#include "apps/packed_numbers.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace headland {
namespace {

std::string encoded(std::string_view text) { return base64({text.begin(), text.end()}); }

TEST(Base64, WritesTheExamplesOfRfc4648) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64({255, 254, 0}), "//4A");
}

TEST(PackedNumbers, RunFromTheLowestToTheHighestAndMarkGaps) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const PackedNumbers packed = pack({100.0, none, 120.0, 110.0});
  EXPECT_EQ(packed.low, 100.0);
  EXPECT_EQ(packed.high, 120.0);
  // 0, 65535, 65534, 32767
  EXPECT_EQ(packed.base64, base64({0, 0, 255, 255, 254, 255, 255, 127}));
  EXPECT_EQ(pack({5.0, 5.0}).base64, base64({0, 0, 0, 0}));
  EXPECT_EQ(pack({none}).base64, base64({255, 255}));
  EXPECT_EQ(pack({}).base64, "");
}

}  // namespace
}  // namespace headland
