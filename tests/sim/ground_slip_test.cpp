// SPDX-License-Identifier: Apache-2.0
#include "sim/ground_slip.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/config/yaml.hpp"

namespace headland {
namespace {

constexpr double kCycle = 0.02;
constexpr double kFirm = 0.16;  // slip per traction

EnergyModel rolling_only() {
  EnergyModel energy;
  energy.mass_kg = 1000.0;
  return energy;
}

// z = by_x x + by_y y, 400 x 400 m.
Ground plane(double by_x, double by_y) {
  std::vector<double> heights;
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column) {
      heights.push_back(100.0 * (by_x * (column - 2) + by_y * (row - 2)));
    }
  }
  return {Farm{}, Terrain::from_grid({-200.0, -200.0}, 100.0, 5, 5, heights)};
}

WheelStep rolling(double speed, const Pose2& pose = {}) {
  return {pose, speed, speed, 0.0, kCycle, false};
}

SlipConfig terrain_only() {
  SlipConfig config;
  config.terrain_factor_ratio = 1.0;
  return config;
}

// The slip after it has settled.
Slip settled(GroundSlip& slip, const WheelStep& wheels) {
  Slip last;
  for (int i = 0; i < 10; ++i) last = slip.step(wheels);
  return last;
}

Slip on(const Ground& ground, const WheelStep& wheels, const EnergyModel& energy = rolling_only()) {
  GroundSlip slip(terrain_only(), energy, ground, 1);
  return settled(slip, wheels);
}

Result<SlipConfig> read(const std::string& text) {
  const auto node = config::Node::parse(text, "f");
  SlipConfig config;
  if (auto ok = config::read_into(*node, config); !ok) return tl::unexpected<Error>(ok.error());
  return config;
}

TEST(GroundSlip, ThereIsNoneByDefaultWhateverTheGround) {
  GroundSlip slip({}, rolling_only(), plane(0.2, 0.3), 1);
  for (int i = 0; i < 100; ++i) {
    const Slip now = slip.step(rolling(1.0));
    EXPECT_EQ(now.loss_ratio, 0.0);
    EXPECT_EQ(now.side_rad, 0.0);
    EXPECT_EQ(now.steering_offset_rad, 0.0);
  }
  EXPECT_NEAR(slip.distance(), 2.0, 1e-12);
  EXPECT_EQ(slip.excess_loss(), 0.0);
}

TEST(GroundSlip, ChangesReplaceTheConstantsAtTheirDistanceOverGround) {
  SlipConfig config;
  config.loss_ratio = 0.5;
  config.side_deg = 3.0;
  config.changes = {{1.0, 0.2, -2.0, 1.0}, {2.0, 0.0, 0.0, 0.0}};
  GroundSlip slip(config, rolling_only(), Ground(), 1);
  const auto steps_with = [&slip](double loss, double side_deg, double offset_deg) {
    int count = 0;
    for (;; ++count) {
      GroundSlip ahead = slip;
      const Slip now = ahead.step(rolling(-1.0));
      if (std::abs(now.loss_ratio - loss) > 1e-12 || count > 1000) break;
      EXPECT_NEAR(now.side_rad, deg_to_rad(side_deg), 1e-12);
      EXPECT_NEAR(now.steering_offset_rad, deg_to_rad(offset_deg), 1e-12);
      EXPECT_NEAR(ahead.excess_loss(), loss, 1e-12);
      slip = ahead;
    }
    return count;
  };
  EXPECT_NEAR(steps_with(0.5, 3.0, 0.0), 100, 1);  // 1 m at 1 cm
  EXPECT_NEAR(slip.distance(), 1.0, 0.011);
  EXPECT_NEAR(steps_with(0.2, -2.0, 1.0), 63, 1);  // 1 m at 1.6 cm
  EXPECT_NEAR(slip.distance(), 2.0, 0.017);
  EXPECT_GT(steps_with(0.0, 0.0, 0.0), 1000);
}

TEST(GroundSlip, LossIsTheSoilsSlipTimesTheTraction) {
  const double level = on(plane(0.0, 0.0), rolling(1.0)).loss_ratio;
  EXPECT_NEAR(level, kFirm * 0.05, 1e-12);  // rolling alone
  EXPECT_NEAR(on(plane(0.2, 0.0), rolling(1.0)).loss_ratio, kFirm * 0.25, 1e-9);
  EXPECT_NEAR(on(plane(0.2, 0.0), rolling(-1.0)).loss_ratio, kFirm * -0.15, 1e-9);
  // Speeding up at 1 m/s2 over a ground that keeps 1 - s of it.
  const WheelStep faster{{}, 1.0, 1.0 + kCycle, 0.0, kCycle, false};
  const double loss = on(Ground(), faster).loss_ratio;
  EXPECT_NEAR(loss, kFirm * (0.05 + (1.0 - loss) / kGravity), 1e-9);
  const WheelStep slower{{}, 1.0, 1.0 - kCycle, 0.0, kCycle, false};
  EXPECT_LT(on(Ground(), slower).loss_ratio, 0.0);
  EnergyModel plough = rolling_only();
  plough.implement_draft_n = 0.3 * 1000.0 * kGravity;
  WheelStep working = rolling(1.0);
  EXPECT_NEAR(on(Ground(), working, plough).loss_ratio, level, 1e-12);
  working.working = true;
  EXPECT_NEAR(on(Ground(), working, plough).loss_ratio, kFirm * 0.35, 1e-12);
}

TEST(GroundSlip, SoilPolygonsSayHowMuch) {
  Farm farm;
  farm.soils.push_back(
      {"dune", SoilClass::kSand, {{{10.0, -9.0}, {90.0, -9.0}, {90.0, 9.0}, {10.0, 9.0}}, {}}});
  const Ground ground(farm, std::nullopt);
  EXPECT_NEAR(on(ground, rolling(1.0, {0.0, 0.0, 0.0})).loss_ratio, 0.16 * 0.05, 1e-12);
  EXPECT_NEAR(on(ground, rolling(1.0, {50.0, 0.0, 0.0})).loss_ratio, 0.38 * 0.20, 1e-12);
}

TEST(GroundSlip, DriftsDownhillInBothGearsAndOnBothSides) {
  for (const double slope : {0.2, -0.2}) {
    const Ground ground = plane(0.0, slope);
    for (const double yaw : {0.0, kPi, 0.25 * kPi}) {
      for (const double speed : {1.0, -1.0}) {
        const Slip slip = on(ground, rolling(speed, {0.0, 0.0, yaw}));
        // The velocity over ground, less that along the heading.
        const double course = yaw + slip.side_rad;
        const Point2 velocity = speed * Point2(std::cos(course), std::sin(course));
        const Point2 left(-std::sin(yaw), std::cos(yaw));
        const double drift = velocity.dot(left);
        const double across = slope * std::cos(yaw);
        EXPECT_NEAR(drift, -kFirm * across, 1e-4) << slope << " " << yaw << " " << speed;
        EXPECT_NEAR(slip.side_rad, (speed > 0.0 ? -1.0 : 1.0) * kFirm * across, 1e-7);
      }
    }
  }
}

TEST(GroundSlip, DriftsOutwardsInBendsInBothGears) {
  for (const double speed : {2.0, -2.0}) {
    for (const double yaw_rate : {0.5, -0.5}) {
      WheelStep bend = rolling(speed);
      bend.yaw_rate = yaw_rate;
      const Slip slip = on(Ground(), bend);
      const double drift = speed * std::sin(slip.side_rad);  // to the left
      const double inwards = speed * yaw_rate;               // acceleration to the left
      EXPECT_LT(drift * inwards, 0.0);
      EXPECT_NEAR(std::abs(slip.side_rad), kFirm * (1.0 - slip.loss_ratio) / kGravity, 1e-9);
    }
  }
}

TEST(GroundSlip, TerrainScalesAndStandingHasNone) {
  SlipConfig twice = terrain_only();
  twice.terrain_factor_ratio = 2.0;
  GroundSlip slip(twice, rolling_only(), plane(0.1, 0.1), 1);
  const Slip driving = settled(slip, rolling(1.0));
  EXPECT_NEAR(driving.loss_ratio, 2.0 * kFirm * 0.15, 1e-7);
  EXPECT_NEAR(driving.side_rad, -2.0 * kFirm * 0.1, 1e-7);
  EXPECT_EQ(slip.excess_loss(), 0.0);
  const Slip standing = slip.step(rolling(0.0));
  EXPECT_EQ(standing.loss_ratio, 0.0);
  EXPECT_EQ(standing.side_rad, 0.0);
}

TEST(GroundSlip, IsBounded) {
  SlipConfig config = terrain_only();
  config.terrain_factor_ratio = 3.0;
  config.loss_ratio = 0.5;
  config.walk = {0.3, 1.0, 10.0, 1.0, 10.0, 1.0};
  GroundSlip slip(config, rolling_only(), plane(0.4, 0.4), 1);
  double most = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Slip now = slip.step(rolling(i % 4000 < 2000 ? 1.0 : -1.0));
    EXPECT_GE(now.loss_ratio, -0.3);
    EXPECT_LE(now.loss_ratio, 0.6);
    EXPECT_LE(std::abs(now.side_rad), deg_to_rad(20.0));
    EXPECT_LE(std::abs(now.steering_offset_rad), deg_to_rad(20.0));
    most = std::max(most, now.loss_ratio);
  }
  EXPECT_EQ(most, 0.6);
}

TEST(GroundSlip, WalksHaveTheirDeviationAndMemoryWhateverTheStep) {
  SlipConfig config;
  config.walk = {0.05, 2.0, 2.0, 4.0, 1.0, 8.0};
  const double memory[] = {2.0, 4.0, 8.0};
  const double deviation[] = {0.05, deg_to_rad(2.0), deg_to_rad(1.0)};
  for (const double speed : {1.0, 10.0}) {
    GroundSlip slip(config, rolling_only(), Ground(), 7);
    // Looked at every 2 m; a half of them for the correlation.
    const int steps = static_cast<int>(std::lround(2.0 / (speed * kCycle)));
    constexpr int kCount = 20000;
    double square[3] = {};
    double product[3] = {};
    double last[3] = {};
    for (int i = 0; i < kCount; ++i) {
      Slip now;
      for (int k = 0; k < steps; ++k) now = slip.step(rolling(speed));
      const double value[] = {now.loss_ratio, now.side_rad, now.steering_offset_rad};
      for (int c = 0; c < 3; ++c) {
        square[c] += value[c] * value[c] / kCount;
        product[c] += value[c] * last[c] / kCount;
        last[c] = value[c];
      }
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(std::sqrt(square[c]), deviation[c], 0.04 * deviation[c]) << c;
      EXPECT_NEAR(product[c] / square[c], std::exp(-2.0 / memory[c]), 0.03) << c;
    }
  }
}

TEST(GroundSlip, WalksBeginInTheirLongRunDistributionAndStandStill) {
  SlipConfig config;
  config.walk.side_deg = 2.0;
  double square = 0.0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    GroundSlip slip(config, rolling_only(), Ground(), seed);
    const double first = slip.step(rolling(0.0)).side_rad;
    EXPECT_EQ(slip.step(rolling(0.0)).side_rad, first);
    square += first * first / 4000;
  }
  EXPECT_NEAR(std::sqrt(square), deg_to_rad(2.0), 0.05 * deg_to_rad(2.0));
}

TEST(GroundSlip, SameSeedSameBytesAndComponentsDoNotDisturbEachOther) {
  SlipConfig config = terrain_only();
  config.walk = {0.05, 2.0, 2.0, 4.0, 1.0, 8.0};
  SlipConfig side_alone;
  side_alone.walk.side_deg = 2.0;
  side_alone.walk.side_memory_m = 4.0;
  GroundSlip a(config, rolling_only(), Ground(), 3);
  GroundSlip b(config, rolling_only(), Ground(), 3);
  GroundSlip other(config, rolling_only(), Ground(), 4);
  GroundSlip side(side_alone, rolling_only(), Ground(), 3);
  EXPECT_EQ(a.step(rolling(1.0)).side_rad, side.step(rolling(1.0)).side_rad);
  b.step(rolling(1.0));
  EXPECT_NE(other.step(rolling(1.0)).side_rad, b.step(rolling(1.0)).side_rad);
  a.step(rolling(1.0));
  for (int i = 0; i < 100; ++i) {
    const Slip one = a.step(rolling(1.0));
    const Slip two = b.step(rolling(1.0));
    EXPECT_EQ(one.loss_ratio, two.loss_ratio);
    EXPECT_EQ(one.side_rad, two.side_rad);
    EXPECT_EQ(one.steering_offset_rad, two.steering_offset_rad);
  }
}

TEST(SlipConfig, ReadsAndNamesTheWrongKey) {
  const auto good = read("changes: [{at_m: 5, side_deg: 4}, {at_m: 9}]\nwalk: {side_deg: 1}\n");
  ASSERT_TRUE(good) << to_string(good.error());
  EXPECT_EQ(good->changes[0].side_deg, 4.0);
  EXPECT_EQ(good->walk.side_deg, 1.0);
  const auto order = read("changes:\n  - {at_m: 9}\n  - {at_m: 5}\n");
  ASSERT_FALSE(order);
  EXPECT_EQ(order.error().where.key, "changes.1.at_m");
  EXPECT_EQ(order.error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(read("changes: [{at_m: -1}]").error().where.key, "changes.0.at_m");
  EXPECT_EQ(read("changes: [{loss_ratio: 0.1}]").error().code, ErrorCode::kMissingKey);
  EXPECT_EQ(read("loss_ratio: 0.7").error().where.key, "loss_ratio");
  EXPECT_EQ(read("side_deg: -21").error().where.key, "side_deg");
  EXPECT_EQ(read("walk: {side_memory_m: 0}").error().where.key, "walk.side_memory_m");
}

}  // namespace
}  // namespace headland
