// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "core/config/yaml.hpp"
#include "sim/lab/acfr_study.hpp"

namespace headland {
namespace {

AcfrStudyConfig shipped() {
  const auto read = config::load<AcfrStudyConfig>(std::string(HEADLAND_SOURCE_DIR) +
                                                  "/config/studies/acfr.yaml");
  EXPECT_TRUE(read);
  AcfrStudyConfig config = *read;
  config.planners = {LocalPlannerKind::kMcts};
  return config;
}

std::string text_of(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(AcfrStudy, TreeSearchHoldsTheBarsWhereItIsDense) {
  AcfrStudyConfig config = shipped();
  config.runs_count = 8;
  config.accuracies_m = {1.0};
  const auto result = run_acfr_study(config, {2, {}, {}, {}});
  ASSERT_TRUE(result) << result.error().what;
  const StudyCell* dense = result->find("mcts/dense/1m");
  ASSERT_NE(dense, nullptr);
  EXPECT_GE(dense->n, 50);
  // (003) Table I: 2.8 %, Table III: 4.70 %; with room for so few waypoints.
  EXPECT_LE(dense->find("fail_1min")->mean, 0.06);
  EXPECT_LE(dense->find("near_collision")->mean, 0.06);
  EXPECT_EQ(dense->find("robot_fault_contact")->mean, 0.0);
  EXPECT_EQ(result->find("mcts/sparse/1m")->find("fail_5min")->mean, 0.0);
  EXPECT_EQ(result->tables.size(), 3U);
}

TEST(AcfrStudy, TheSameSeedGivesTheSameBytesWhateverTheJobs) {
  AcfrStudyConfig config = shipped();
  config.runs_count = 2;
  config.accuracies_m = {2.0};
  config.dense_m2 = 30.0;
  config.iterations_count = 100;
  std::string before;
  for (const int jobs : {1, 2}) {
    const auto out = std::filesystem::path(::testing::TempDir()) / ("acfr_" + std::to_string(jobs));
    std::filesystem::remove_all(out);
    std::filesystem::create_directories(out);
    ASSERT_TRUE(run_acfr_study(config, {jobs, out, {}, {}}));
    const std::string now = text_of(out / "episodes.csv");
    EXPECT_GT(now.size(), 1000U);
    if (!before.empty()) EXPECT_EQ(now, before);
    before = now;
  }
}

}  // namespace
}  // namespace headland
