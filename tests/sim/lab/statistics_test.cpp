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

TEST(Quantile, IsLinearBetweenTheValues) {
  EXPECT_EQ(quantile({7.0}, 0.99), 7.0);
  EXPECT_DOUBLE_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 1.0), 4.0);
}

TEST(Cvar5, IsTheMeanOfTheLowestTwentieth) {
  std::vector<double> sample;
  for (int i = 40; i > 0; --i) sample.push_back(i);
  EXPECT_DOUBLE_EQ(cvar5(sample), 1.5);
  sample.push_back(0.0);  // 41 values: the lowest three
  EXPECT_DOUBLE_EQ(cvar5(sample), 1.0);
  EXPECT_DOUBLE_EQ(cvar5({3.0, 5.0}), 3.0);
}

// By hand: 0 of n is z^2 / (n + z^2) wide; 5 of 10 from the tables; 493 and 485 of 500 are rows
// of the table beside which the crowd study stands.
TEST(Proportion, GivesWilsonsInterval) {
  const Statistic none = proportion(0, 10);
  EXPECT_EQ(none.mean, 0.0);
  EXPECT_EQ(*none.ci_low, 0.0);
  EXPECT_NEAR(*none.ci_high, 0.2775, 1e-4);
  const Statistic half = proportion(5, 10);
  EXPECT_NEAR(*half.ci_low, 0.2366, 1e-4);
  EXPECT_NEAR(*half.ci_high, 0.7634, 1e-4);
  EXPECT_NEAR(*proportion(493, 500).ci_low, 0.971, 5e-4);
  EXPECT_NEAR(*proportion(493, 500).ci_high, 0.993, 5e-4);
  EXPECT_NEAR(*proportion(485, 500).ci_low, 0.951, 5e-4);
  EXPECT_EQ(*proportion(10, 10).ci_high, 1.0);
}

TEST(Proportion, CoversTheTrueShareInNineteenOfTwentySamples) {
  RandomStream random(12, "test");
  int covered = 0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    int hits = 0;
    for (int i = 0; i < 200; ++i) hits += random.uniform() < 0.97 ? 1 : 0;
    const Statistic s = proportion(hits, 200);
    covered += *s.ci_low <= 0.97 && 0.97 <= *s.ci_high ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(covered) / kTrials, 0.95, 0.02);
}

TEST(McNemar, KnowsBinomialTailsByHand) {
  EXPECT_EQ(mcnemar(0, 0), 1.0);
  EXPECT_NEAR(mcnemar(1, 9), 2.0 * 11.0 / 1024.0, 1e-12);
  EXPECT_NEAR(mcnemar(9, 1), mcnemar(1, 9), 1e-15);
  EXPECT_NEAR(mcnemar(0, 5), 2.0 / 32.0, 1e-12);
  EXPECT_EQ(mcnemar(5, 5), 1.0);
  EXPECT_NEAR(mcnemar(500, 600), 0.0028, 2e-4);  // normal: z = (100 - 1) / sqrt(1100)
}

}  // namespace
}  // namespace headland
