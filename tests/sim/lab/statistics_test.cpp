// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/statistics.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

TEST(Summarize, GivesOnlyTheMeanOfASingleValue) {
  const Statistic s = summarize({3.5});
  EXPECT_EQ(s.mean, 3.5);
  EXPECT_FALSE(s.std);
  EXPECT_FALSE(s.ci_low);
}

TEST(Summarize, KnowsASmallSampleByHand) {
  const Statistic s = summarize({4.0, 1.0, 3.0, 2.0, 5.0});
  EXPECT_DOUBLE_EQ(s.mean, 3.0);
  EXPECT_DOUBLE_EQ(*s.median, 3.0);
  EXPECT_NEAR(*s.std, 1.5811388, 1e-6);
  EXPECT_NEAR(*s.p95, 4.8, 1e-12);
  EXPECT_NEAR(*s.ci_high - s.mean, 2.7764 * 1.5811388 / std::sqrt(5.0), 1e-6);
  EXPECT_NEAR(s.mean - *s.ci_low, *s.ci_high - s.mean, 1e-12);
}

TEST(StudentT95, MatchesTheTables) {
  EXPECT_NEAR(student_t_95(1), 12.706, 1e-3);
  EXPECT_NEAR(student_t_95(6), 2.4469, 1e-3);
  EXPECT_NEAR(student_t_95(7), 2.3646, 2e-3);
  EXPECT_NEAR(student_t_95(10), 2.2281, 1e-3);
  EXPECT_NEAR(student_t_95(19), 2.0930, 1e-3);
  EXPECT_NEAR(student_t_95(100), 1.9840, 1e-3);
}

TEST(Summarize, CoversTheTrueMeanInNineteenOfTwentySamples) {
  RandomStream random(11, "test");
  int covered = 0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> sample;
    for (int i = 0; i < 10; ++i) sample.push_back(random.normal());
    const Statistic s = summarize(sample);
    covered += *s.ci_low <= 0.0 && 0.0 <= *s.ci_high ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(covered) / kTrials, 0.95, 0.015);
}

}  // namespace
}  // namespace headland
