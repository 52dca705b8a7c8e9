// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "core/config/yaml.hpp"
#include "global_planner/mission/mission_plan.hpp"
#include "tests/support/outline_checker.hpp"

namespace headland {
namespace {

const std::filesystem::path kMissions =
    std::filesystem::path(HEADLAND_SOURCE_DIR) / "config/missions";

// The mission's own keys; the simulation's, behind them, are not the planner's business.
Result<MissionConfig> read_mission(const std::string& name) {
  const std::filesystem::path file = kMissions / (name + ".yaml");
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto node = config::Node::parse(text.substr(0, text.find("\nsimulation:")), file.string());
  if (!node) return tl::unexpected<Error>(node.error());
  MissionConfig mission;
  if (auto read = config::read_into(*node, mission); !read) {
    return tl::unexpected<Error>(read.error());
  }
  return mission;
}

Path path_of_leg(const VehiclePlan& vehicle, int leg) {
  Path path;
  for (const PlanStage& stage : vehicle.stages) {
    for (const PathPiece& piece : stage.path.pieces()) {
      if (piece.leg == leg) path.append(piece);
    }
  }
  return path;
}

// Every leg of the plan, judged by a checker that shares nothing with the planner but the farm.
void expect_inside(const Mission& mission, const VehiclePlan& vehicle) {
  const Farm& farm = mission.farm;
  std::vector<Row> rows;
  std::map<std::string, int> number;
  double spacing = farm.row_parcels.front().row_spacing_m;
  for (const RowRef ref : farm.all_rows()) {
    number[farm.row_name(ref)] = static_cast<int>(rows.size());
    rows.push_back(farm.row(ref));
    spacing =
        std::min(spacing, farm.row_parcels[static_cast<std::size_t>(ref.parcel)].row_spacing_m);
  }
  test::OutlineChecker checker(farm, rows, spacing - 0.02, vehicle.vehicle.footprint);
  const int legs = static_cast<int>(vehicle.legs.size());
  for (int leg = 0; leg < legs; ++leg) {
    const LegKind kind = vehicle.legs[static_cast<std::size_t>(leg)].kind;
    if (kind == LegKind::kCharge || kind == LegKind::kTask) continue;
    std::set<int> own;
    for (int near = std::max(0, leg - 1); near <= std::min(legs - 1, leg + 1); ++near) {
      const PlanLeg& other = vehicle.legs[static_cast<std::size_t>(near)];
      if (other.kind == LegKind::kRow) own.insert(number.at(other.id));
    }
    EXPECT_EQ(checker.complaint(path_of_leg(vehicle, leg), own), "")
        << vehicle.legs[static_cast<std::size_t>(leg)].id;
  }
}

class ShippedMission : public testing::TestWithParam<const char*> {};

TEST_P(ShippedMission, PlansWithinTheGapAndNeverLeavesHeadlandOrRoad) {
  const auto config = read_mission(GetParam());
  ASSERT_TRUE(config) << to_string(config.error());
  for (const std::string& farm : config->farm) {
    if (!std::filesystem::exists(resolve_path(farm, kMissions))) GTEST_SKIP() << "no " << farm;
  }
  const auto mission = load_mission(*config, kMissions);
  ASSERT_TRUE(mission) << to_string(mission.error());
  const auto plan = plan_mission(*mission);
  ASSERT_TRUE(plan) << to_string(plan.error());
  // On hills the bound takes the better direction of every row.
  EXPECT_LE(plan->gap_ratio(), mission->ground.flat() ? 0.03 : 0.25);
  EXPECT_GE(plan->min_margin_j, 0.0);
  for (const VehiclePlan& vehicle : plan->vehicles) {
    EXPECT_GE(vehicle.min_soc, vehicle.vehicle.battery.reserve_soc - 1e-9);
    expect_inside(*mission, vehicle);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedMission,
                         testing::Values("girona_orchard", "kiato_vineyard", "ebs221_field",
                                         "polito_orchard", "jojos_vineyard", "jojos_vineyard_carob",
                                         "estate_1000_rows", "hilly_parcels"),
                         [](const auto& mission) { return std::string(mission.param); });

}  // namespace
}  // namespace headland
