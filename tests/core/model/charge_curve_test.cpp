// SPDX-License-Identifier: Apache-2.0
#include "core/model/charge_curve.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

constexpr double kCapacity = 3.6e7;  // [J]

ChargeCurve random_curve(RandomStream& random) {
  std::vector<ChargePoint> points;
  double soc = random.uniform(-0.1, 0.5);
  const int count = 1 + random.index(6);
  for (int i = 0; i < count; ++i) {
    points.push_back({soc, random.uniform(100.0, 50000.0)});
    soc += random.uniform(0.001, 0.3);
  }
  return ChargeCurve(points);
}

// Simpson's rule on d(soc) / power, between the points of the curve.
double integrated(const ChargeCurve& curve, double from, double to) {
  std::vector<double> borders{from, to};
  for (const ChargePoint& p : curve.points()) {
    if (p.soc > from && p.soc < to) borders.push_back(p.soc);
  }
  std::sort(borders.begin(), borders.end());
  double total = 0.0;
  for (std::size_t i = 1; i < borders.size(); ++i) {
    constexpr int kSteps = 2000;
    const double h = (borders[i] - borders[i - 1]) / kSteps;
    for (int k = 0; k < kSteps; ++k) {
      const double a = borders[i - 1] + k * h;
      total += h / 6.0 *
               (1.0 / curve.power(a) + 4.0 / curve.power(a + 0.5 * h) + 1.0 / curve.power(a + h));
    }
  }
  return total * kCapacity;
}

TEST(ChargeCurve, ConstantPowerChargesEvenly) {
  const ChargeCurve curve(10000.0);
  EXPECT_EQ(curve.power(0.0), 10000.0);
  EXPECT_EQ(curve.power(1.0), 10000.0);
  EXPECT_NEAR(curve.time(0.2, 0.7, kCapacity), 1800.0, 1e-9);
  EXPECT_NEAR(curve.soc_after(0.2, 1800.0, kCapacity), 0.7, 1e-12);
  EXPECT_EQ(curve.soc_after(0.2, 1e6, kCapacity), 1.0);
  EXPECT_EQ(curve.time(0.7, 0.7, kCapacity), 0.0);
  EXPECT_EQ(curve.soc_after(0.7, 0.0, kCapacity), 0.7);
}

TEST(ChargeCurve, ConstantCurrentThenConstantVoltage) {
  const ChargeCurve curve = ChargeCurve::cc_cv(8000.0, 0.8, 0.1);
  EXPECT_EQ(curve.power(0.0), 8000.0);
  EXPECT_EQ(curve.power(0.8), 8000.0);
  EXPECT_NEAR(curve.power(0.9), 4400.0, 1e-9);
  EXPECT_NEAR(curve.power(1.0), 800.0, 1e-9);
  EXPECT_EQ(curve.max_power(), 8000.0);
  // Power falls by 7200 W over 0.2: exponential, ln(10) / 36000 for the whole of it.
  EXPECT_NEAR(curve.time(0.8, 1.0, kCapacity), std::log(10.0) / 36000.0 * kCapacity, 1e-6);
  EXPECT_EQ(ChargeCurve::cc_cv(8000.0, 1.0, 0.1).power(1.0), 8000.0);
  EXPECT_NEAR(ChargeCurve::cc_cv(8000.0, 0.0, 0.5).power(0.5), 6000.0, 1e-9);
}

TEST(ChargeCurve, TimesAreThoseOfNumericalIntegration) {
  RandomStream random(1, "curves");
  for (int i = 0; i < 50; ++i) {
    const ChargeCurve curve = random_curve(random);
    const double from = random.uniform(0.0, 0.9);
    const double to = random.uniform(from, 1.0);
    const double exact = curve.time(from, to, kCapacity);
    EXPECT_NEAR(exact, integrated(curve, from, to), 1e-6 * exact + 1e-9);
  }
}

TEST(ChargeCurve, SocAfterUndoesTime) {
  RandomStream random(2, "curves");
  for (int i = 0; i < 2000; ++i) {
    const ChargeCurve curve = random_curve(random);
    const double from = random.uniform();
    const double to = random.uniform(from, 1.0);
    EXPECT_NEAR(curve.soc_after(from, curve.time(from, to, kCapacity), kCapacity), to, 1e-11);
  }
}

TEST(ChargeCurve, TimesAddUp) {
  RandomStream random(3, "curves");
  for (int i = 0; i < 500; ++i) {
    const ChargeCurve curve = random_curve(random);
    const double a = random.uniform();
    const double c = random.uniform(a, 1.0);
    const double b = random.uniform(a, c);
    const double whole = curve.time(a, c, kCapacity);
    EXPECT_NEAR(curve.time(a, b, kCapacity) + curve.time(b, c, kCapacity), whole,
                1e-10 * whole + 1e-12);
    EXPECT_GE(whole, (c - a) * kCapacity / curve.max_power() * (1.0 - 1e-12));
  }
}

TEST(ChargeCurve, NearlyConstantPowerKeepsItsDigits) {
  for (const double change : {1e-3, 1e-6, 1e-8, 1e-10, 1e-12, -1e-6, -1e-10}) {
    const ChargeCurve curve({{0.0, 10000.0}, {1.0, 10000.0 + change}});
    EXPECT_NEAR(curve.time(0.0, 1.0, kCapacity), 3600.0, 3600.0 * (1e-13 + std::abs(change) / 1e4));
    EXPECT_NEAR(curve.soc_after(0.0, 1800.0, kCapacity), 0.5, 1e-13 + std::abs(change) / 1e4);
  }
}

TEST(ChargeCurve, LowerIsTheLowerOfBothEverywhere) {
  RandomStream random(4, "curves");
  for (int i = 0; i < 300; ++i) {
    const ChargeCurve a = random_curve(random);
    const ChargeCurve b = random_curve(random);
    const ChargeCurve low = lower(a, b);
    for (int k = 0; k <= 200; ++k) {
      const double soc = k / 200.0;
      const double expected = std::min(a.power(soc), b.power(soc));
      EXPECT_NEAR(low.power(soc), expected, 1e-9 * expected) << soc;
    }
    EXPECT_GE(low.time(0.0, 1.0, kCapacity),
              std::max(a.time(0.0, 1.0, kCapacity), b.time(0.0, 1.0, kCapacity)) * (1.0 - 1e-9));
  }
}

TEST(ChargeCurve, AWeakChargerHidesTheBatterysKnee) {
  const ChargeCurve battery = ChargeCurve::cc_cv(20000.0, 0.8, 0.1);
  const ChargeCurve both = lower(ChargeCurve(5000.0), battery);
  EXPECT_EQ(both.power(0.8), 5000.0);
  const double knee = 0.8 + 0.2 * 15000.0 / 18000.0;
  EXPECT_NEAR(both.power(knee - 1e-6), 5000.0, 1e-6);
  EXPECT_LT(both.power(knee + 1e-3), 4999.0);
  EXPECT_TRUE(both.concave_energy());
}

TEST(ChargeCurve, ConcaveMeansThatPowerNeverRises) {
  EXPECT_TRUE(ChargeCurve(5.0).concave_energy());
  EXPECT_TRUE(ChargeCurve::cc_cv(5.0, 0.5, 0.1).concave_energy());
  EXPECT_FALSE(ChargeCurve({{0.0, 2.0}, {0.1, 5.0}, {1.0, 1.0}}).concave_energy());
}

TEST(ChargeCurveDeathTest, BrokenCurvesAreRefused) {
  EXPECT_DEATH(ChargeCurve(std::vector<ChargePoint>{}), "without points");
  EXPECT_DEATH(ChargeCurve({{0.5, 1.0}, {0.5, 2.0}}), "out of order");
  EXPECT_DEATH(ChargeCurve({{0.5, 0.0}}), "no power");
}

}  // namespace
}  // namespace headland
