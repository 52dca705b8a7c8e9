// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/config/yaml.hpp"
#include "sim/lab/rows_study.hpp"

namespace headland {
namespace {

double mean(const StudyResult& result, const std::string& cell, const std::string& metric) {
  const StudyCell* found = result.find(cell);
  const Statistic* value = found != nullptr ? found->find(metric) : nullptr;
  EXPECT_NE(value, nullptr) << cell << " " << metric;
  return value != nullptr ? value->mean : -1.0;
}

// The shipped study with shorter rows and one run.
RowsStudyConfig shipped() {
  const auto file = config::load<RowsStudyConfig>("config/studies/rows.yaml");
  EXPECT_TRUE(file) << (file ? "" : to_string(file.error()));
  RowsStudyConfig config = file ? *file : RowsStudyConfig{};
  config.runs_count = 1;
  for (RowScenario& scene : config.scenes) scene.layout.length_m = 30.0;
  return config;
}

TEST(RowsStudy, OursKeepsTheBarsInAllScenes) {
  const auto result = run_rows_study(shipped(), "", 2);
  ASSERT_TRUE(result);
  const struct {
    const char* cell;
    double mae, max, lateral;
  } bars[] = {{"orchard_bare", 0.03, 0.10, 0.147},
              {"orchard_leaf", 0.05, 0.20, 0.216},
              {"vineyard_leaf", 0.055, 0.20, 0.128}};
  for (const auto& bar : bars) {
    EXPECT_LE(mean(*result, bar.cell, "mae_m"), bar.mae) << bar.cell;
    EXPECT_LE(mean(*result, bar.cell, "max_m"), bar.max) << bar.cell;
    EXPECT_LT(mean(*result, bar.cell, "lateral_mae_m"), bar.lateral) << bar.cell;
    EXPECT_GE(mean(*result, bar.cell, "row_end_first_m"), 8.0) << bar.cell;
    EXPECT_LE(mean(*result, bar.cell, "row_end_error_m"), 0.3) << bar.cell;
    EXPECT_EQ(mean(*result, bar.cell, "driven_ratio"), 1.0) << bar.cell;
    EXPECT_LT(mean(*result, bar.cell, "mae_m"),
              mean(*result, std::string(bar.cell) + "/published", "mae_m"));
  }
}

// The pines of data/lidar/pine_plot, tiled along rows: plants that nobody modelled.
TEST(RowsStudy, OursKeepsTheBarsAmongRealPlants) {
  const auto file = config::load<RowsStudyConfig>("config/studies/rows_pines.yaml");
  ASSERT_TRUE(file) << to_string(file.error());
  RowsStudyConfig config = *file;
  config.runs_count = 1;
  for (RowScenario& scene : config.scenes) scene.layout.length_m = 30.0;
  const auto result = run_rows_study(config, "config/studies", 2);
  if (!result && result.error().code == ErrorCode::kFileNotFound) GTEST_SKIP();
  ASSERT_TRUE(result) << to_string(result.error());
  for (const RowScenario& scene : config.scenes) {
    EXPECT_LE(mean(*result, scene.name, "mae_m"), 0.05) << scene.name;
    EXPECT_LE(mean(*result, scene.name, "max_m"), 0.20) << scene.name;
    EXPECT_GE(mean(*result, scene.name, "row_end_first_m"), 8.0) << scene.name;
  }
}

TEST(RowsStudy, TheResultDoesNotDependOnJobsAndNamesWhatIsWrong) {
  RowsStudyConfig config = shipped();
  config.scenes.resize(1);
  config.scenes[0].layout.length_m = 10.0;
  config.runs_count = 2;
  const auto one = run_rows_study(config, "", 1);
  const auto two = run_rows_study(config, "", 2);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(mean(*one, "orchard_bare", "mae_m"), mean(*two, "orchard_bare", "mae_m"));
  config.scenes[0].layout.rows_count = 3;
  const auto odd = run_rows_study(config, "");
  ASSERT_FALSE(odd);
  EXPECT_EQ(odd.error().where.key, "rows_count");
  config.scenes[0].layout.rows_count = 2;
  config.scenes[0].scan = ScannedPlants{"no_such.pcd", 0.0, {1.0}};
  EXPECT_EQ(run_rows_study(config, "").error().code, ErrorCode::kFileNotFound);
  config.scenes[0].scan->offsets_m.clear();
  EXPECT_EQ(run_rows_study(config, "").error().where.key, "scan.offsets_m");
  config.scenes.clear();
  EXPECT_FALSE(run_rows_study(config, ""));
}

}  // namespace
}  // namespace headland
