// SPDX-License-Identifier: Apache-2.0
#include "core/model/soil.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace headland {
namespace {

// Brixius' equations (ASABE D497) for a vehicle on four equal wheels.
struct Wheel {
  double vehicle_kg = 0.0;
  double width_m = 0.0;
  double diameter_m = 0.0;
};

double mobility(const Wheel& wheel, double cone_index_kpa) {
  const double load_kn = wheel.vehicle_kg * 9.80665 / 4.0 / 1000.0;
  return cone_index_kpa * wheel.width_m * wheel.diameter_m / load_kn * (1.0 + 5.0 * 0.2) /
         (1.0 + 3.0 * wheel.width_m / wheel.diameter_m);
}
double rolling_ratio(double bn, double slip) {
  return 1.0 / bn + 0.04 + 0.5 * slip / std::sqrt(bn);
}
double slip_at(double bn, double traction_ratio) {
  const double share = (traction_ratio - 0.04) / (0.88 * (1.0 - std::exp(-0.1 * bn)));
  return -std::log(1.0 - share) / 7.5;
}

TEST(Soil, TheTableIsWhatBrixiusGivesForFarmRobots) {
  const Wheel wheels[] = {{600.0, 0.2, 0.7}, {1500.0, 0.3, 0.9}, {4000.0, 0.4, 1.3}};
  const std::pair<SoilClass, double> classes[] = {
      {SoilClass::kFirm, 1200.0}, {SoilClass::kTilled, 900.0}, {SoilClass::kSoft, 450.0}};
  for (const auto& [soil, cone_index] : classes) {
    double low = 1.0;
    double high = 0.0;
    double low_slip = 1.0;
    double high_slip = 0.0;
    for (const Wheel& wheel : wheels) {
      const double bn = mobility(wheel, cone_index);
      low = std::min(low, rolling_ratio(bn, 0.05));
      high = std::max(high, rolling_ratio(bn, 0.05));
      low_slip = std::min(low_slip, slip_at(bn, 0.3) / 0.3);
      high_slip = std::max(high_slip, slip_at(bn, 0.3) / 0.3);
    }
    const SoilResistance found = soil_resistance(soil);
    EXPECT_GT(found.rolling_ratio, low - 0.001) << config::enum_name(soil);
    EXPECT_LT(found.rolling_ratio, high + 0.001) << config::enum_name(soil);
    EXPECT_GT(found.slip_per_traction, low_slip - 0.005) << config::enum_name(soil);
    EXPECT_LT(found.slip_per_traction, high_slip + 0.005) << config::enum_name(soil);
  }
}

TEST(Soil, SandSlipsAsASoilOfItsResistanceDoes) {
  const SoilResistance sand = soil_resistance(SoilClass::kSand);
  EXPECT_NEAR(rolling_ratio(7.2, slip_at(7.2, 0.3)), sand.rolling_ratio, 0.002);
  EXPECT_NEAR(slip_at(7.2, 0.3) / 0.3, sand.slip_per_traction, 0.005);
}

TEST(Soil, WorseSoilsResistMore) {
  SoilResistance last;
  for (const auto& [soil, name] : config::EnumNames<SoilClass>::values) {
    const SoilResistance here = soil_resistance(soil);
    EXPECT_GT(here.rolling_ratio, last.rolling_ratio) << name;
    EXPECT_GE(here.slip_per_traction, last.slip_per_traction) << name;
    last = here;
  }
}

}  // namespace
}  // namespace headland
