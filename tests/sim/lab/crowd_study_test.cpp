// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/crowd_study.hpp"

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "core/config/yaml.hpp"

namespace headland {
namespace {

CrowdStudyConfig small() {
  auto config = config::load<CrowdStudyConfig>("config/studies/crowd.yaml");
  EXPECT_TRUE(config) << to_string(config.error());
  config->runs_count = 6;
  config->iterations_count = 20;
  return *config;
}

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(CrowdStudy, HasACellForEachPlannerWithPeopleWhoSeeAndWhoDoNot) {
  const CrowdStudyConfig config = small();
  const auto result = run_crowd_study(config);
  ASSERT_TRUE(result) << to_string(result.error());
  ASSERT_EQ(result->cells.size(), 2 * config.planners.size() + 2);
  EXPECT_TRUE(result->find("mcts/visible"));
  EXPECT_TRUE(result->find("fs/invisible"));
  for (const StudyCell& cell : result->cells) {
    SCOPED_TRACE(cell.name);
    EXPECT_EQ(cell.n, 6);
    const double sum =
        cell.find("success")->mean + cell.find("collision")->mean + cell.find("timeout")->mean;
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_TRUE(cell.find("success")->ci_low);
    EXPECT_TRUE(cell.find("plan_ms")->p99);
    for (const char* metric : {"near_miss_episodes", "gap_m", "gap_cvar5_m", "disturbed_ratio"}) {
      EXPECT_TRUE(cell.find(metric)) << metric;
    }
  }
  const StudyCell* reference = result->find("orca_holonomic/visible");
  ASSERT_TRUE(reference);
  EXPECT_EQ(reference->find("success")->mean, 1.0);
  EXPECT_GT(reference->find("time_s")->mean, 14.4);
  ASSERT_EQ(result->tables.size(), 4U);
  for (const StudyTable& table : result->tables) {
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size()) << table.title;
  }
  ASSERT_EQ(result->plots.size(), 1U);
  EXPECT_EQ(result->plots.front().series.size(), result->cells.size());
  EXPECT_TRUE(result->files.empty());
}

TEST(CrowdStudy, APlannerThatIsNamedTwiceIsAnError) {
  CrowdStudyConfig config = small();
  config.planners.push_back(config.planners.front());
  const auto result = run_crowd_study(config);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(result.error().where.key, "planners");
}

TEST(CrowdStudy, FilmsEpisodesOfEachPlanner) {
  StudyRun run;
  run.films_count = 3;
  CrowdStudyConfig config = small();
  config.planners = {LocalPlannerKind::kMcts, LocalPlannerKind::kFailSafe};
  const auto result = run_crowd_study(config, run);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->films.size(), 3U);
  EXPECT_TRUE(result->films[0].name.starts_with("mcts/"));
  EXPECT_TRUE(result->films[2].name.starts_with("orca_holonomic/"));
  for (const Film& film : result->films) {
    SCOPED_TRACE(film.name);
    ASSERT_GT(film.frames.size(), 10U);
    EXPECT_EQ(film.frames.front().time_s, 0.0);
    EXPECT_NEAR(film.frames[1].time_s, 0.25, 1e-12);
    EXPECT_EQ((film.frames.front().robot.position() - film.path.front()).norm(), 0.0);
    EXPECT_GE(film.frames.front().agents.size(), 2U);
    EXPECT_FALSE(film.note.empty());
  }
}

TEST(CrowdStudy, WritesTheSameEpisodesWhateverTheJobs) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "headland_crowd_study";
  std::filesystem::remove_all(folder);
  const CrowdStudyConfig config = small();
  for (const int jobs : {1, 2}) {
    std::filesystem::create_directories(folder / std::to_string(jobs));
    const auto result = run_crowd_study(config, {jobs, folder / std::to_string(jobs)});
    ASSERT_TRUE(result);
    EXPECT_EQ(result->files, (std::vector<std::string>{"episodes.csv", "times.csv"}));
  }
  const std::string one = content(folder / "1" / "episodes.csv");
  EXPECT_GT(one.size(), 1000U);
  EXPECT_EQ(one, content(folder / "2" / "episodes.csv"));
}

}  // namespace
}  // namespace headland
