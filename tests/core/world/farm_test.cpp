// SPDX-License-Identifier: Apache-2.0
#include "core/world/farm.hpp"

#include <gtest/gtest.h>

namespace headland {
namespace {

Polygon rectangle(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

double total_area(const std::vector<Polygon>& list) {
  double sum = 0.0;
  for (const Polygon& p : list) sum += area(p);
  return sum;
}

TEST(Farm, FindsByIdOrGivesNull) {
  Farm farm;
  farm.row_parcels.resize(2);
  farm.row_parcels[1].id = "b";
  farm.pois.push_back({"dock", "dock", {}});
  farm.chargers.push_back({"c1", {}, ChargeCurve(22000.0), 1});
  EXPECT_EQ(farm.find_parcel("b"), &farm.row_parcels[1]);
  EXPECT_EQ(farm.find_parcel("c"), nullptr);
  EXPECT_EQ(farm.find_poi("dock"), &farm.pois[0]);
  EXPECT_EQ(farm.find_poi("c1"), nullptr);
  EXPECT_EQ(farm.find_charger("c1"), &farm.chargers[0]);
  EXPECT_EQ(farm.find_charger(""), nullptr);
}

TEST(Farm, DrivableAreaOfAnEmptyFarmIsEmpty) { EXPECT_TRUE(drivable_area(Farm{}).empty()); }

TEST(Farm, DrivableAreaIsTheSumOfItsPartsWithoutKeepOuts) {
  Farm farm;
  RowParcel parcel;
  parcel.boundary = rectangle(0, 0, 100, 50);
  farm.row_parcels.push_back(parcel);
  EXPECT_NEAR(total_area(drivable_area(farm)), 5000.0, 1e-6);
  farm.row_parcels[0].headland_outside_m = 8.0;
  // Steiner: A + P r + pi r^2.
  EXPECT_NEAR(total_area(drivable_area(farm)), 5000.0 + 300.0 * 8.0 + kPi * 64.0, 0.5);

  farm.row_parcels[0].headland_outside_m = 0.0;
  farm.free_parcels.push_back({"yard", rectangle(150, 0, 170, 50)});
  EXPECT_EQ(drivable_area(farm).size(), 2u);
  farm.roads.push_back({"road", {{100, 25}, {150, 25}}, 5.0});
  EXPECT_EQ(drivable_area(farm).size(), 1u);
  EXPECT_NEAR(total_area(drivable_area(farm)), 5000.0 + 1000.0 + 250.0, 1e-6);

  farm.keep_outs.push_back({"shed", rectangle(155, 10, 160, 20)});
  EXPECT_NEAR(total_area(drivable_area(farm)), 6250.0 - 50.0, 1e-6);
}

TEST(Farm, GatesPoisAndChargersAreDiscs) {
  Farm farm;
  farm.gates.push_back({"gate", {0, 0}, 6.0});
  farm.pois.push_back({"dock", "dock", {100, 0, 0}});
  farm.chargers.push_back({"c1", {200, 0, 0}, ChargeCurve(22000.0), 1});
  const auto discs = drivable_area(farm);
  ASSERT_EQ(discs.size(), 3u);
  EXPECT_NEAR(total_area(discs), kPi * (9.0 + 16.0 + 16.0), 0.3);
}

}  // namespace
}  // namespace headland
