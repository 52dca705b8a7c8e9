// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/mission_config.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include "core/config/yaml.hpp"

namespace headland {
namespace {

const std::filesystem::path kMissions =
    std::filesystem::path(HEADLAND_SOURCE_DIR) / "config/missions";

MissionConfig kiato() {
  MissionConfig config;
  config.name = "test";
  config.farm = {"../farms/kiato_vineyard.geojson"};
  MissionVehicleConfig vehicle;
  vehicle.id = "carob";
  vehicle.model = "../vehicles/carob.yaml";
  vehicle.start.poi = "dock";
  config.vehicles = {vehicle};
  return config;
}

std::string error_of(const MissionConfig& config) {
  const auto mission = load_mission(config, kMissions);
  return mission ? "" : to_string(mission.error());
}

TEST(Mission, CoversAllRowsUnlessToldOtherwise) {
  const auto mission = load_mission(kiato(), kMissions);
  ASSERT_TRUE(mission) << to_string(mission.error());
  EXPECT_EQ(mission->rows.size(), 26u);
  EXPECT_EQ(mission->vehicles.front().vehicle.name, "AGC CAROB");
}

TEST(Mission, CoversNamedRowsOnly) {
  MissionConfig config = kiato();
  const auto all = load_mission(config, kMissions);
  ASSERT_TRUE(all);
  config.tasks.front().rows = {all->farm.row_name(all->rows[3]), all->farm.row_name(all->rows[5])};
  const auto mission = load_mission(config, kMissions);
  ASSERT_TRUE(mission) << to_string(mission.error());
  ASSERT_EQ(mission->rows.size(), 2u);
  EXPECT_EQ(mission->farm.row_name(mission->rows[1]), all->farm.row_name(all->rows[5]));
}

TEST(Mission, UnknownNamesListTheKnownOnes) {
  MissionConfig config = kiato();
  config.vehicles.front().start.poi = "barn";
  EXPECT_NE(error_of(config).find("no poi or charger 'barn' in the farm; the farm has: "),
            std::string::npos)
      << error_of(config);
  config = kiato();
  config.tasks.front().cover = {"west"};
  EXPECT_NE(error_of(config).find("no row parcel 'west' in the farm; allowed: all, "),
            std::string::npos)
      << error_of(config);
  config = kiato();
  config.tasks.front().rows = {"west/r1"};
  EXPECT_NE(error_of(config).find("no row 'west/r1' in the farm"), std::string::npos)
      << error_of(config);
}

TEST(Mission, AbsentFilesAreNamed) {
  MissionConfig config = kiato();
  config.vehicles.front().model = "../vehicles/none.yaml";
  EXPECT_NE(error_of(config).find("none.yaml: no such file"), std::string::npos)
      << error_of(config);
  config = kiato();
  config.farm = {"none.geojson"};
  EXPECT_NE(error_of(config).find("none.geojson: no such file"), std::string::npos)
      << error_of(config);
}

TEST(Mission, APlaceIsEitherNamedOrGivenByBothCoordinates) {
  PlaceConfig place;
  EXPECT_TRUE(place.check());
  place.poi = "dock";
  EXPECT_FALSE(place.check());
  place.x_m = 1.0;
  EXPECT_TRUE(place.check());
  place.y_m = 2.0;
  EXPECT_TRUE(place.check());
  place.poi.clear();
  EXPECT_FALSE(place.check());
  place.y_m.reset();
  EXPECT_TRUE(place.check());
}

TEST(Mission, DataVariableIsReplaced) {
  const char* data = std::getenv("HEADLAND_DATA");
  const std::string root = data != nullptr ? data : "../shared/data";
  EXPECT_EQ(resolve_path("$HEADLAND_DATA/farms/a.geojson", "x"), root + "/farms/a.geojson");
  EXPECT_EQ(resolve_path("../farms/a.geojson", "config/missions"), "config/farms/a.geojson");
}

TEST(Mission, EveryShippedVehicleLoads) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(kMissions.parent_path() / "vehicles")) {
    const auto vehicle = config::load<Vehicle>(entry.path());
    EXPECT_TRUE(vehicle) << to_string(vehicle.error());
    ++count;
  }
  EXPECT_GE(count, 4);
}

TEST(Mission, WritesBackWhatItReads) {
  const MissionConfig config = kiato();
  const std::string text = config::to_yaml(config);
  const auto node = config::Node::parse(text, "effective.yaml");
  ASSERT_TRUE(node);
  MissionConfig again;
  const auto read = config::read_into(*node, again);
  ASSERT_TRUE(read) << to_string(read.error()) << "\n" << text;
  EXPECT_EQ(config::to_yaml(again), text);
}

}  // namespace
}  // namespace headland
