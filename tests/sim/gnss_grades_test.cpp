// SPDX-License-Identifier: Apache-2.0
// Float and single fixes and multipath of the simulated receiver.
#include <cmath>

#include <gtest/gtest.h>

#include "sim/sensors.hpp"

namespace headland {
namespace {

constexpr double kTick = 0.1;

struct Fix {
  double time = 0.0;
  Point2 error{0.0, 0.0};
  double deviation = 0.0;
};

// What the receiver gives of a vehicle that stands at the origin.
std::vector<Fix> fixes(const GnssConfig& gnss, int ticks) {
  SensorConfig config;
  config.gnss = gnss;
  Sensors sensors(Vehicle(), config, 3);
  std::vector<Fix> all;
  for (int i = 0; i < ticks; ++i) {
    for (const Measurement& m : sensors.sense({}, 0.0, i * kTick)) {
      if (m.kind != MeasurementKind::kPosition) continue;
      all.push_back({m.time, {m.value[0], m.value[1]}, m.deviation});
    }
  }
  return all;
}

TEST(GnssGrades, FloatSpellsKeepAnErrorAndOwnUpToIt) {
  GnssConfig gnss;
  gnss.noise_m = 0.01;
  gnss.float_fix = {0.05, 10.0, 0.4};
  int in_spell = 0;
  int spells = 0;
  int drifted = 0;  // to another spell's, without a good fix between
  double squares = 0.0;
  Point2 kept(0.0, 0.0);  // of the present spell
  bool before = false;
  const auto all = fixes(gnss, 200000);
  for (const Fix& fix : all) {
    const bool now = fix.deviation > 0.1;
    if (!now) {
      EXPECT_LT(fix.error.norm(), 0.06);
      EXPECT_NEAR(fix.deviation, 0.01, 1e-12);
    } else {
      EXPECT_NEAR(fix.deviation, std::hypot(0.01, 0.4), 1e-12);
      if (!before) {
        ++spells;
        kept = fix.error;
        squares += fix.error.squaredNorm();
      }
      drifted += (fix.error - kept).norm() > 0.1 ? 1 : 0;
      ++in_spell;
    }
    before = now;
  }
  // 10 s of spell after 20 s of good fixes on average; two in a row look like one.
  EXPECT_NEAR(in_spell / static_cast<double>(all.size()), 1.0 / 3.0, 0.03);
  EXPECT_NEAR(spells, 667, 80);
  EXPECT_LT(drifted, in_spell / 50);
  EXPECT_NEAR(std::sqrt(squares / (2.0 * spells)), 0.4, 0.04);
}

TEST(GnssGrades, ASingleFixIsWorse) {
  GnssConfig gnss;
  gnss.single_fix = {100.0, 1e3, 2.0};  // from nearly at once
  const auto all = fixes(gnss, 100);
  EXPECT_NEAR(all.back().deviation, 2.0, 1e-6);
  EXPECT_GT(all.back().error.norm(), 0.1);
  EXPECT_EQ(all.back().error, all[50].error);
}

TEST(GnssGrades, MultipathComesAtItsRateUnannounced) {
  GnssConfig gnss;
  gnss.noise_m = 0.01;
  gnss.multipath_probability = 0.2;
  int astray = 0;
  Point2 sum(0.0, 0.0);
  const auto all = fixes(gnss, 20000);
  for (const Fix& fix : all) {
    EXPECT_NEAR(fix.deviation, 0.01, 1e-12);
    if (fix.error.norm() < 1.0) continue;
    ++astray;
    EXPECT_GT(fix.error.norm(), 4.9);
    EXPECT_LT(fix.error.norm(), 40.1);
    sum += fix.error;
  }
  EXPECT_NEAR(astray, 4000, 200);
  EXPECT_LT((sum / astray).norm(), 1.5);  // to all sides
}

TEST(GnssGrades, TheyLeaveTheNoiseAsItIs) {
  GnssConfig gnss;
  gnss.noise_m = 0.01;
  const auto good = fixes(gnss, 2000);
  gnss.float_fix = {0.05, 10.0, 0.4};
  gnss.multipath_probability = 0.1;
  const auto worse = fixes(gnss, 2000);
  ASSERT_EQ(good.size(), worse.size());
  int same = 0;
  for (std::size_t i = 0; i < good.size(); ++i) same += good[i].error == worse[i].error ? 1 : 0;
  EXPECT_GT(same, 800);
  EXPECT_LT(same, 1900);
}

}  // namespace
}  // namespace headland
