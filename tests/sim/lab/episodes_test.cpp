// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/episodes.hpp"

#include <atomic>
#include <csignal>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/random.hpp"

namespace headland {
namespace {

using Cells = std::vector<std::vector<Episode>>;

std::filesystem::path fresh_folder(const char* name) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "headland_episodes" / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

EpisodeGrid small_grid() { return {"test", "seed: 1\n", {"x_m", "y_m"}, {"a", "b", "c"}, 20}; }

// One to three rows; the scenario is the run's, the planner's luck the cell's.
Episode episode(int cell, int run) {
  RandomStream scenario(1, fmt::format("scenario {}", run));
  Episode result;
  const int rows = 1 + scenario.index(3);
  for (int i = 0; i < rows; ++i) result.rows.push_back({scenario.uniform(), cell + 1.0 / 3.0});
  result.plan_ms = {0.123, 4.56, 0.1234};
  return result;
}

std::string uninterrupted(const char* name) {
  const auto folder = fresh_folder(name);
  EXPECT_TRUE(run_episodes(small_grid(), {1, folder}, episode));
  return content(folder / "episodes.csv");
}

TEST(Episodes, AreTheSameBytesWhateverTheJobs) {
  const std::string one = uninterrupted("one_job");
  const auto folder = fresh_folder("two_jobs");
  const auto cells = run_episodes(small_grid(), {2, folder}, episode);
  ASSERT_TRUE(cells);
  EXPECT_EQ(content(folder / "episodes.csv"), one);
  ASSERT_EQ(cells->size(), 3U);
  ASSERT_EQ((*cells)[2].size(), 20U);
  EXPECT_EQ((*cells)[2][19].rows, episode(2, 19).rows);
  EXPECT_EQ((*cells)[2][19].plan_ms, (std::vector<double>{0.12, 0.12, 4.6}));
}

TEST(Episodes, WithoutAFolderGiveTheSame) {
  const auto kept = run_episodes(small_grid(), {1, fresh_folder("kept")}, episode);
  const auto not_kept = run_episodes(small_grid(), {}, episode);
  ASSERT_TRUE(kept && not_kept);
  for (std::size_t c = 0; c < kept->size(); ++c) {
    for (std::size_t r = 0; r < (*kept)[c].size(); ++r) {
      EXPECT_EQ((*kept)[c][r].rows, (*not_kept)[c][r].rows);
      EXPECT_EQ((*kept)[c][r].plan_ms, (*not_kept)[c][r].plan_ms);
    }
  }
}

// A child process runs the study and kills itself, as kill -9 does, in the middle of an episode.
TEST(Episodes, SurviveThatTheProcessIsKilled) {
  const auto folder = fresh_folder("killed");
  constexpr int kBefore = 17;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    int begun = 0;
    (void)run_episodes(small_grid(), {1, folder}, [&](int cell, int run) {
      if (begun++ == kBefore) std::raise(SIGKILL);
      return episode(cell, run);
    });
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  std::atomic<int> again = 0;
  const auto cells = run_episodes(small_grid(), {2, folder}, [&](int cell, int run) {
    ++again;
    return episode(cell, run);
  });
  ASSERT_TRUE(cells);
  EXPECT_EQ(again, 3 * 20 - kBefore);
  EXPECT_EQ(content(folder / "episodes.csv"), uninterrupted("not_killed"));
}

TEST(Episodes, WhoseLinesAreTornAreRunAgain) {
  const auto folder = fresh_folder("torn");
  ASSERT_TRUE(run_episodes(small_grid(), {1, folder}, episode));
  const std::string whole = content(folder / "episodes.csv");
  const std::string times = content(folder / "times.csv");
  for (const auto& [file, text] : {std::pair{"episodes.csv", whole}, {"times.csv", times}}) {
    std::ofstream(folder / file, std::ios::binary) << text.substr(0, text.size() - 3);
    int again = 0;
    ASSERT_TRUE(run_episodes(small_grid(), {1, folder}, [&](int cell, int run) {
      ++again;
      return episode(cell, run);
    }));
    EXPECT_EQ(again, 1);
    EXPECT_EQ(content(folder / "episodes.csv"), whole);
    EXPECT_EQ(content(folder / "times.csv"), times);
  }
}

TEST(Episodes, ThatAreDoneAreNotRunAgainAndMoreCanFollow) {
  const auto folder = fresh_folder("more");
  EpisodeGrid grid = small_grid();
  grid.runs_count = 5;
  ASSERT_TRUE(run_episodes(grid, {1, folder}, episode));
  int run = 0;
  const auto counting = [&](int cell, int number) {
    ++run;
    return episode(cell, number);
  };
  ASSERT_TRUE(run_episodes(grid, {1, folder}, counting));
  EXPECT_EQ(run, 0);
  ASSERT_TRUE(run_episodes(small_grid(), {1, folder}, counting));
  EXPECT_EQ(run, 3 * 15);
  EXPECT_EQ(content(folder / "episodes.csv"), uninterrupted("at_once"));
}

TEST(Episodes, StopWhenToldAndGoOnLater) {
  const auto folder = fresh_folder("stopped");
  std::vector<double> shares;
  StudyRun run{1, folder};
  run.progress = [&](double share) { shares.push_back(share); };
  run.stopped = [&] { return shares.size() >= 6; };
  const auto stopped = run_episodes(small_grid(), run, episode);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kStopped);
  EXPECT_NE(to_string(stopped.error()).find("6 of 60"), std::string::npos);
  EXPECT_EQ(shares.back(), 0.1);
  run.stopped = nullptr;
  ASSERT_TRUE(run_episodes(small_grid(), run, episode));
  EXPECT_EQ(shares.size(), 60U);
  EXPECT_EQ(content(folder / "episodes.csv"), uninterrupted("not_stopped"));
}

TEST(Episodes, OfAnotherConfigurationOrMoreRunsAreNotTouched) {
  const auto folder = fresh_folder("other");
  ASSERT_TRUE(run_episodes(small_grid(), {1, folder}, episode));
  const std::string before = content(folder / "episodes.csv");
  EpisodeGrid other = small_grid();
  other.config_yaml = "seed: 2\n";
  EpisodeGrid fewer = small_grid();
  fewer.runs_count = 19;
  EpisodeGrid columns = small_grid();
  columns.columns = {"x_m", "z_m"};
  for (const EpisodeGrid& grid : {other, fewer, columns}) {
    const auto cells = run_episodes(grid, {1, folder}, episode);
    ASSERT_FALSE(cells);
    EXPECT_EQ(cells.error().code, ErrorCode::kFileNotWritable);
    EXPECT_NE(to_string(cells.error()).find("choose another directory"), std::string::npos);
  }
  EXPECT_EQ(content(folder / "episodes.csv"), before);
}

TEST(Episodes, EndWithAnErrorWhenTheyCannotBeKept) {
  const auto folder = fresh_folder("gone");
  int run = 0;
  const auto cells = run_episodes(small_grid(), {1, folder}, [&](int cell, int number) {
    if (run++ == 3) {
      std::filesystem::remove_all(folder);
    }
    return episode(cell, number);
  });
  ASSERT_FALSE(cells);
  EXPECT_EQ(cells.error().code, ErrorCode::kFileNotWritable);
  EXPECT_EQ(run, 4);
}

}  // namespace
}  // namespace headland
