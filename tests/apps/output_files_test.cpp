// SPDX-License-Identifier: Apache-2.0
#include "apps/output_files.hpp"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace headland::apps {
namespace {

std::filesystem::path fresh_directory(const char* name) {
  const auto directory = std::filesystem::path(testing::TempDir()) / "headland_output" / name;
  std::filesystem::remove_all(directory);
  return directory;
}

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(OutputFiles, AreWrittenWholeAndLeaveNoParts) {
  const auto directory = fresh_directory("whole");
  ASSERT_TRUE(write_files(directory, {{"summary.json", "{}"}, {"trace.csv", "a\n"}}));
  EXPECT_EQ(content(directory / "summary.json"), "{}");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    EXPECT_NE(entry.path().extension(), ".part");
    ++files;
  }
  EXPECT_EQ(files, 2);
}

TEST(OutputFiles, OfAnEarlierCommandAreRemovedAndOthersKept) {
  const auto directory = fresh_directory("stale");
  ASSERT_TRUE(write_files(directory, {{"trace.csv", "old"}}));
  std::ofstream(directory / "notes.txt") << "mine";
  ASSERT_TRUE(write_files(directory, {{"summary.json", "new"}}));
  EXPECT_FALSE(std::filesystem::exists(directory / "trace.csv"));
  EXPECT_EQ(content(directory / "notes.txt"), "mine");
}

TEST(OutputFiles, ThatAreKeptStay) {
  const auto directory = fresh_directory("kept");
  ASSERT_TRUE(write_files(directory, {{"episodes.csv", "hours"}, {"trace.csv", "old"}}));
  ASSERT_TRUE(write_files(directory, {{"results.json", "{}"}}, {"episodes.csv"}));
  EXPECT_EQ(content(directory / "episodes.csv"), "hours");
  EXPECT_FALSE(std::filesystem::exists(directory / "trace.csv"));
}

TEST(OutputFiles, ADirectoryInTheWayIsAnErrorBeforeAnythingIsTouched) {
  const auto directory = fresh_directory("in_the_way");
  ASSERT_TRUE(write_files(directory, {{"trace.csv", "old"}}));
  std::filesystem::create_directory(directory / "summary.json");
  const auto written = write_files(directory, {{"summary.json", "new"}});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kFileNotWritable);
  EXPECT_EQ(content(directory / "trace.csv"), "old");
}

TEST(OutputFiles, AFileInPlaceOfTheDirectoryIsAnError) {
  const auto directory = fresh_directory("file");
  std::filesystem::create_directories(directory.parent_path());
  std::ofstream(directory) << "x";
  EXPECT_FALSE(prepare_output(directory / "out"));
}

}  // namespace
}  // namespace headland::apps
