// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "core/world/farm_io.hpp"
#include "global_planner/coverage/transitions.hpp"
#include "tests/support/coverage_fields.hpp"
#include "tests/support/outline_checker.hpp"

namespace headland {
namespace {

using test::all_rows;
using test::OutlineChecker;
using test::tracked_robot;
using test::tractor;

std::filesystem::path data_folder() {
  const char* folder = std::getenv("HEADLAND_DATA");
  return folder != nullptr ? std::filesystem::path(folder)
                           : std::filesystem::path(HEADLAND_SOURCE_DIR) / "../shared/data";
}

Farm loaded(const std::vector<std::filesystem::path>& files, double outside = 0.0) {
  Result<Farm> farm = load_farm(files, {outside});
  if (!farm) throw std::runtime_error(to_string(farm.error()));
  return *farm;
}

std::filesystem::path farm_file(const std::string& name) {
  return std::filesystem::path(HEADLAND_SOURCE_DIR) / "config/farms" / name;
}

std::vector<Site> stops_of(const Farm& farm) {
  std::vector<Site> stops;
  for (const Charger& c : farm.chargers) stops.push_back({c.pose, c.pose, c.id});
  for (const Poi& p : farm.pois) {
    // The vineyard's other places lie off its roads.
    if (p.role == "dock" || p.role == "warehouse") stops.push_back({p.pose, p.pose, p.id});
  }
  return stops;
}

struct Timed {
  Transitions ways;
  double seconds;
};

Timed timed_build(const Farm& farm, const Vehicle& vehicle) {
  const auto begin = std::chrono::steady_clock::now();
  Result<Transitions> ways =
      Transitions::build(farm, Ground(), farm.all_rows(), stops_of(farm), vehicle);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  if (!ways) throw std::runtime_error(to_string(ways.error()));
  return {std::move(*ways), taken.count()};
}

// All sites are joined to all others; every turn and every `stride`-th longer way is inside.
void expect_joined_and_inside(const Transitions& ways, const Farm& farm, const Vehicle& vehicle,
                              int stride) {
  const std::vector<Row> rows = all_rows(farm);
  OutlineChecker checker(farm, rows, farm.row_parcels[0].row_spacing_m - 0.01, vehicle.footprint);
  const int ends = 2 * static_cast<int>(rows.size());
  int turns = 0;
  int longer = 0;
  int checked = 0;
  int failed = 0;
  for (int from = 0; from < ways.sites(); ++from) {
    for (int to = 0; to < ways.sites(); ++to) {
      if (from == to || (from < ends && from / 2 == to / 2)) continue;
      const std::string name = ways.site(from).name + " -> " + ways.site(to).name;
      if (!std::isfinite(ways.cost(from, to).length_m)) {
        if (++failed <= 10) ADD_FAILURE() << "no way " << name;
        continue;
      }
      const bool turn = ways.kind(from, to) == LegKind::kTurn;
      turns += turn ? 1 : 0;
      longer += turn ? 0 : 1;
      if ((turn ? turns : longer) % (turn ? std::max(1, stride / 20) : stride) != 0) continue;
      ++checked;
      const Path path = ways.path(from, to);
      EXPECT_NEAR(path.length(), ways.cost(from, to).length_m, 1e-5) << name;
      std::set<int> own;
      if (from < ends) own.insert(from / 2);
      if (to < ends) own.insert(to / 2);
      const std::string complaint = checker.complaint(path, own);
      if (!complaint.empty() && ++failed <= 10) ADD_FAILURE() << name << ": " << complaint;
    }
  }
  EXPECT_EQ(failed, 0);
  std::printf("  %d turns, %d longer ways, %d paths checked\n", turns, longer, checked);
}

TEST(TransitionsSlow, TheFarmsOfTheSeeds) {
  for (const char* name : {"girona_orchard.geojson", "kiato_vineyard.geojson",
                           "ebs221_field.geojson", "polito_orchard.geojson"}) {
    const Farm farm = loaded({farm_file(name)});
    for (const Vehicle& vehicle : {tractor(), tracked_robot()}) {
      const Timed built = timed_build(farm, vehicle);
      std::printf("%s, %s: %d sites in %.2f s\n", name, vehicle.name.c_str(), built.ways.sites(),
                  built.seconds);
      expect_joined_and_inside(built.ways, farm, vehicle, 23);
    }
  }
}

TEST(TransitionsSlow, TheRealVineyard) {
  const auto map = data_folder() / "farms/jojos_vineyard/jojos_vineyard.geojson";
  if (!std::filesystem::exists(map)) GTEST_SKIP() << "no " << map << "; set HEADLAND_DATA";
  const Farm farm = loaded({map, farm_file("jojos_vineyard_overlay.geojson")}, 8.0);
  ASSERT_EQ(all_rows(farm).size(), 92U);
  for (const Vehicle& vehicle : {tractor(), tracked_robot()}) {
    const Timed built = timed_build(farm, vehicle);
    std::printf("vineyard, %s: %d sites in %.2f s\n", vehicle.name.c_str(), built.ways.sites(),
                built.seconds);
    EXPECT_LT(built.seconds, 15.0);  // ten times what it takes
    expect_joined_and_inside(built.ways, farm, vehicle, 409);
  }
}

TEST(TransitionsSlow, AnEstateOfAThousandRows) {
  const Farm farm = test::make_estate(8, 5, 25);
  ASSERT_EQ(all_rows(farm).size(), 1000U);
  for (const Vehicle& vehicle : {tractor(), tracked_robot()}) {
    const Timed built = timed_build(farm, vehicle);
    std::printf("estate, %s: %d sites in %.2f s\n", vehicle.name.c_str(), built.ways.sites(),
                built.seconds);
    EXPECT_LT(built.seconds, 120.0);
    expect_joined_and_inside(built.ways, farm, vehicle, 80021);
  }
}

}  // namespace
}  // namespace headland
