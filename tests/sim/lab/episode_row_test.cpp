// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/episode_row.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

struct Pair {
  double far_m = 1.0;
  double long_s = 2.0;

  template <class V>
  void visit(V& v) {
    v("far_m", far_m);
    v("long_s", long_s);
  }
};

TEST(EpisodeRow, GoesToNumbersAndBack) {
  EXPECT_EQ(row_columns<Pair>(), (std::vector<std::string>{"far_m", "long_s"}));
  EXPECT_EQ(to_row(Pair{3.0, 4.0}), (std::vector<double>{3.0, 4.0}));
  const Pair back = from_row<Pair>({5.0, 6.0});
  EXPECT_EQ(back.far_m, 5.0);
  EXPECT_EQ(back.long_s, 6.0);
}

TEST(EpisodeRow, OfAnotherLengthIsABrokenInvariant) {
  EXPECT_DEATH(from_row<Pair>({5.0}), "value for each column");
}

}  // namespace
}  // namespace headland
