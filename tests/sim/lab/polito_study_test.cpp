// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/polito_study.hpp"

#include <gtest/gtest.h>

#include "core/config/yaml.hpp"

namespace headland {
namespace {

PolitoStudyConfig quick() {
  PolitoStudyConfig config;
  config.runs_count = 2;
  config.accuracies_m = {0.02};
  config.grid_lookahead_m = {0.75, 2.0};
  config.grid_waypoint_pitch_m = {0.33, 1.65};
  config.cycles_s = {0.05};
  config.orchard.tree_rows_count = 2;
  config.orchard.field_width_m = 24.0;
  return config;
}

TEST(PolitoStudy, FillsTheCellsThatToolsRelyOn) {
  const auto result = run_polito_study(quick());
  ASSERT_TRUE(result);
  for (const char* name :
       {"track/seed", "track/seed/threshold", "track/seed/noise_0.02",
        "track/seed/noise_0.02/threshold", "track/ours", "track/ours/noise_0.02",
        "track/ours/noise_0.02/raw", "track/ours/noise_0.02/odometry_1.01",
        "track/ours/noise_0.02/heading_0.5", "track/ours/arc_plant", "grid/LD_0.75/WPP_0.33",
        "grid/LD_2/WPP_1.65", "cycle/seed/t_0.05", "cycle/ours/t_0.05"}) {
    const StudyCell* cell = result->find(name);
    ASSERT_NE(cell, nullptr) << name;
    for (const char* metric : {"atd_m", "oscillation_count", "ra_1pm"}) {
      ASSERT_NE(cell->find(metric), nullptr) << name << " " << metric;
    }
    EXPECT_EQ(cell->find("completed_ratio")->mean, 1.0) << name;
  }
  EXPECT_EQ(result->find("track/ours/noise_0.02")->n, 2);
  EXPECT_TRUE(result->find("track/ours/noise_0.02")->find("ra_1pm")->ci_low);
}

TEST(PolitoStudy, DrawsTheFiguresAndTablesOfTheSeed) {
  const auto result = run_polito_study(quick());
  ASSERT_TRUE(result);
  ASSERT_EQ(result->plots.size(), 6u);
  for (const Plot& plot : result->plots) {
    ASSERT_FALSE(plot.series.empty()) << plot.title;
    for (const PlotSeries& series : plot.series) {
      EXPECT_FALSE(series.x.empty()) << plot.title << series.name;
      EXPECT_EQ(series.x.size(), series.y.size());
    }
  }
  ASSERT_EQ(result->tables.size(), 2u);
  for (const StudyTable& table : result->tables) {
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
  }
  EXPECT_EQ(result->tables[1].rows[1][2], "0.6219");  // (004) Table 3, 2 cm
}

TEST(PolitoStudy, GivesTheSameFiguresTwice) {
  const auto first = run_polito_study(quick());
  const auto second = run_polito_study(quick(), 3);
  ASSERT_EQ(first->cells.size(), second->cells.size());
  for (std::size_t i = 0; i < first->cells.size(); ++i) {
    EXPECT_EQ(first->cells[i].find("ra_1pm")->mean, second->cells[i].find("ra_1pm")->mean);
  }
}

TEST(PolitoStudy, NamesWhatDoesNotFit) {
  PolitoStudyConfig config = quick();
  config.orchard.row_start_m = 1.0;
  const auto result = run_polito_study(config);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kTurnDoesNotFit);
}

TEST(PolitoStudy, FileHoldsTheDefaults) {
  const auto file = config::load<PolitoStudyConfig>("config/studies/polito.yaml");
  ASSERT_TRUE(file) << to_string(file.error());
  EXPECT_EQ(config::to_yaml(*file), config::to_yaml(PolitoStudyConfig{}));
}

}  // namespace
}  // namespace headland
