// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/ebs221_study.hpp"

#include <gtest/gtest.h>

#include "core/config/yaml.hpp"

namespace headland {
namespace {

const StudyResult& study() {
  static const StudyResult result = [] {
    Ebs221StudyConfig config;
    config.runs_count = 3;
    return run_ebs221_study(config).value();
  }();
  return result;
}

TEST(Ebs221Study, FillsTheCellsThatToolsRelyOn) {
  for (const char* name :
       {"tour/seed/60deg", "tour/seed/30deg", "tour/true/60deg", "tour/true/30deg"}) {
    const StudyCell* cell = study().find(name);
    ASSERT_NE(cell, nullptr) << name;
    EXPECT_EQ(cell->find("optimal")->mean, 1.0) << name;
    EXPECT_GT(cell->find("planning_s")->mean, 0.0) << name;
    EXPECT_LT(cell->find("planning_s")->mean, 8.0) << name;  // the seed's genetic algorithm
  }
  for (const char* name : {"track/seed/D", "track/seed/E", "track/seed/F", "track/seed/E/perturbed",
                           "track/ours/D", "track/ours/F", "track/ours/fishtail"}) {
    const StudyCell* cell = study().find(name);
    ASSERT_NE(cell, nullptr) << name;
    for (const char* metric : {"overall_rms_m", "row_rms_m", "turn_rms_m", "true_overall_rms_m",
                               "max_m", "wrong_gear_count", "mean_speed_mps"}) {
      ASSERT_NE(cell->find(metric), nullptr) << name << " " << metric;
    }
  }
  EXPECT_EQ(study().find("track/seed/E/perturbed")->n, 3);
}

TEST(Ebs221Study, DrawsThreePlotsPerDriveAndTheTables) {
  std::size_t drives = 0;
  for (const StudyCell& cell : study().cells) {
    const bool drawn = cell.name.rfind("track/", 0) == 0 && cell.n == 1;
    drives += drawn ? 1 : 0;
  }
  EXPECT_EQ(study().plots.size(), 3 * drives);
  for (const Plot& plot : study().plots) {
    for (const PlotSeries& series : plot.series) {
      EXPECT_FALSE(series.x.empty()) << plot.title;
      EXPECT_EQ(series.x.size(), series.y.size()) << plot.title;
    }
  }
  ASSERT_EQ(study().tables.size(), 2u);
  for (const StudyTable& table : study().tables) {
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
  }
}

TEST(Ebs221Study, NamesTheOrderThatLeavesOutARow) {
  Ebs221StudyConfig config;
  config.part_f.rows[2] = 1;
  const auto result = run_ebs221_study(config);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(result.error().where.key, "part_f.rows");
}

TEST(Ebs221Study, FileHoldsTheDefaults) {
  const auto file = config::load<Ebs221StudyConfig>("config/studies/ebs221.yaml");
  ASSERT_TRUE(file) << to_string(file.error());
  EXPECT_EQ(config::to_yaml(*file), config::to_yaml(Ebs221StudyConfig{}));
}

}  // namespace
}  // namespace headland
