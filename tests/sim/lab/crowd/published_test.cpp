// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/crowd/published.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace headland {
namespace {

using Record = std::map<std::string, std::string>;

std::vector<Record> read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  const auto cells = [](const std::string& line) {
    std::vector<std::string> parts;
    std::istringstream in(line.substr(0, line.find('\r')));
    for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
    return parts;
  };
  std::string line;
  std::getline(stream, line);
  const auto names = cells(line);
  std::vector<Record> records;
  while (std::getline(stream, line)) {
    const auto values = cells(line);
    Record record;
    for (std::size_t i = 0; i < names.size(); ++i) record[names[i]] = values.at(i);
    records.push_back(record);
  }
  return records;
}

double mean(const std::vector<Record>& records, const std::string& key) {
  double sum = 0.0;
  for (const Record& record : records) sum += std::stod(record.at(key));
  return sum / static_cast<double>(records.size());
}

// What the tables of the crowd study quote, recomputed from the published episodes.
TEST(PublishedCrowdResults, AreThoseOfTheFiles) {
  const char* given = std::getenv("HEADLAND_DATA");
  const auto folder =
      std::filesystem::path(given != nullptr ? given : "../shared/data") / "mcts_grnn";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder << "; set HEADLAND_DATA";
  for (const PublishedCrowdResult& published : kPublishedCrowdResults) {
    SCOPED_TRACE(published.name);
    const auto all = read(folder / published.file);
    ASSERT_EQ(all.size(), static_cast<std::size_t>(kPublishedEpisodes));
    std::vector<Record> successes;
    int collisions = 0;
    int near = 0;
    std::array<double, 3> count{};
    std::array<double, 3> good{};
    for (const Record& record : all) {
      const bool success = record.at("result") == "Success";
      if (success) successes.push_back(record);
      collisions += record.at("result") == "Collision" ? 1 : 0;
      near += std::stod(record.at("near_misses")) > 0.0 ? 1 : 0;
      const int people = std::stoi(record.at("num_agents"));
      const std::size_t size = people <= 4 ? 0 : people <= 8 ? 1 : 2;
      count.at(size) += 1.0;
      good.at(size) += success ? 1.0 : 0.0;
    }
    EXPECT_EQ(static_cast<int>(successes.size()), published.success);
    EXPECT_EQ(collisions, published.collision);
    EXPECT_EQ(near, published.near_miss_episodes);
    EXPECT_NEAR(mean(successes, "path_time"), published.time_s, 1e-3);
    EXPECT_NEAR(mean(successes, "path_length"), published.length_m, 1e-3);
    EXPECT_NEAR(mean(all, "%_disturbed"), published.disturbed_ratio, 6e-5);
    EXPECT_NEAR(mean(all, "%_half_disturbed"), published.disturbed_half_ratio, 6e-5);
    EXPECT_NEAR(mean(all, "%_quart_disturbed"), published.disturbed_quarter_ratio, 6e-5);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(good.at(i) / count.at(i), published.success_ratio.at(i), 1e-9) << i;
    }
  }
}

}  // namespace
}  // namespace headland
