// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/episode_log.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include <gtest/gtest.h>

namespace headland {
namespace {

std::filesystem::path fresh_file(const char* name) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "headland_episode_log";
  std::filesystem::create_directories(folder);
  std::filesystem::remove(folder / name);
  return folder / name;
}

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

EpisodeLog log_at(const std::filesystem::path& file, std::uint64_t hash = 1) {
  return {file, "test", hash, {"a_m", "b_s"}, {"x/visible", "x/invisible"}};
}

TEST(EpisodeLog, GivesBackTheNumbersToTheBit) {
  const EpisodeLog log = log_at(fresh_file("bits.csv"));
  const double inf = std::numeric_limits<double>::infinity();
  const EpisodeRows rows = {{0.1 + 0.2, -0.0}, {1e-310, 1.0 / 3.0}, {inf, 12345678901234567.0}};
  ASSERT_TRUE(log.write({}));
  ASSERT_TRUE(log.append({1, 4}, rows));
  ASSERT_TRUE(log.append({0, 2}, {{std::nan(""), 1.0}}));
  const auto read = log.read();
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ(read->at({1, 4}), rows);
  EXPECT_TRUE(std::signbit(read->at({1, 4})[0][1]));
  EXPECT_TRUE(std::isnan(read->at({0, 2})[0][0]));
}

TEST(EpisodeLog, IsATableForPeople) {
  const auto file = fresh_file("table.csv");
  const EpisodeLog log = log_at(file);
  ASSERT_TRUE(log.write({{{1, 0}, {{3.0, 0.5}}}, {{0, 7}, {{1.0, 2.0}, {1.5, 2.5}}}}));
  EXPECT_EQ(content(file),
            "# headland episodes: test, configuration 0000000000000001\n"
            "cell,run,row,rows_count,a_m,b_s\n"
            "x/visible,7,0,2,1,2\n"
            "x/visible,7,1,2,1.5,2.5\n"
            "x/invisible,0,0,1,3,0.5\n");
}

// The file is cut at each of its bytes: what comes back is always a beginning of what was written.
TEST(EpisodeLog, DropsWhatWasCutOffWhereverThatIs) {
  const auto file = fresh_file("torn.csv");
  const EpisodeLog log = log_at(file);
  const EpisodeRows one = {{1.25, 2.5}};
  const EpisodeRows two = {{12.5, 25.0}, {13.5, 26.0}};
  ASSERT_TRUE(log.write({}));
  const std::size_t begin = content(file).size();
  ASSERT_TRUE(log.append({0, 0}, one));
  const std::size_t after_one = content(file).size();
  ASSERT_TRUE(log.append({1, 0}, two));
  const std::string whole = content(file);
  for (std::size_t length = begin; length <= whole.size(); ++length) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, length);
    const auto read = log.read();
    ASSERT_TRUE(read);
    const std::size_t expected = (length >= after_one ? 1U : 0U) + (length == whole.size() ? 1 : 0);
    ASSERT_EQ(read->size(), expected) << length;
    if (expected > 0) {
      EXPECT_EQ(read->at({0, 0}), one);
    }
  }
}

TEST(EpisodeLog, LeavesOutDamagedLinesAndWhatIsNotOfTheGrid) {
  const auto file = fresh_file("damaged.csv");
  const EpisodeLog log = log_at(file);
  ASSERT_TRUE(log.write({}));
  std::ofstream(file, std::ios::app) << "x/visible,0,0,1,1.0,2.o\n"
                                        "x/visible,1,0,1,1.0\n"
                                        "x/visible,2,0,1,1.0,2.0,3.0\n"
                                        "y/visible,3,0,1,1.0,2.0\n"
                                        "x/visible,-4,0,1,1.0,2.0\n"
                                        "x/visible,5,1,2,1.0,2.0\n"
                                        "\n"
                                        "x/visible,6,0,1,1.0,2.0\n";
  const auto read = log.read();
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 1U);
  EXPECT_EQ(read->begin()->first.run, 6);
}

TEST(EpisodeLog, OfAnotherConfigurationIsAnErrorThatSaysWhatToDo) {
  const auto file = fresh_file("other.csv");
  ASSERT_TRUE(log_at(file, 1).write({}));
  const auto read = log_at(file, 2).read();
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kFileNotWritable);
  EXPECT_NE(to_string(read.error()).find("--out, or delete"), std::string::npos);
}

TEST(EpisodeLog, AnotherCommandsFileHoldsNoEpisodes) {
  const auto file = fresh_file("cells.csv");
  std::ofstream(file) << "cell,n,metric,mean\ntrack/seed,1,max_m,0.1\n";
  const auto read = log_at(file).read();
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->empty());
}

TEST(EpisodeLog, WithoutAFolderCannotBeWritten) {
  const EpisodeLog log = log_at(fresh_file("none") / "episodes.csv");
  EXPECT_TRUE(log.read());
  ASSERT_FALSE(log.write({}));
  EXPECT_FALSE(log.append({0, 0}, {{1.0, 2.0}}));
}

}  // namespace
}  // namespace headland
