// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/prediction_study.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/config/yaml.hpp"

namespace headland {
namespace {

namespace fs = std::filesystem;

const std::string kConfigFolder = HEADLAND_SOURCE_DIR "/config/studies";

// A folder of the running test.
fs::path folder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const fs::path path = fs::path(testing::TempDir()) / (std::string("prediction_") + test->name());
  fs::create_directories(path);
  return path;
}

// Two who walk on straight side by side at 1 m/s, and one who turns off at step `turn`.
std::string obsmat(int steps, int turn) {
  std::string text;
  for (int k = 0; k < steps; ++k) {
    const double t = 0.4 * k;
    const double aside = 0.4 * std::max(0, k - turn);
    text += fmt::format("{} 1 {} 0 0 0 0 0\n", 10 * k, t);
    text += fmt::format("{} 2 {} 0 1 0 0 0\n", 10 * k, t);
    text += fmt::format("{} 3 {} 0 {} 0 0 0\n", 10 * k, t, 50.0 + aside);
  }
  return text;
}

// Sheep in two drives: a flock that goes on at 1 m/s.
std::string drives() {
  std::string text = "trial,drive,t_s,agent,role,x_m,y_m\n";
  for (int drive = 1; drive <= 2; ++drive) {
    for (int k = 0; k < 120; ++k) {
      for (int sheep = 1; sheep <= 4; ++sheep) {
        text += fmt::format("1,{},{},{},sheep,{},{}\n", drive, 0.1 * k, sheep,
                            0.1 * k * drive + sheep % 2, sheep);
      }
      text += fmt::format("1,{},{},9,dog,{},2\n", drive, 0.1 * k, 0.1 * k * drive - 30.0);
    }
  }
  return text;
}

void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

PredictionStudyConfig study_of(const Recording& recording) {
  PredictionStudyConfig config;
  config.tracks = {recording};
  config.prediction.learned.weights = HEADLAND_SOURCE_DIR "/config/models/crowd_response.weights";
  return config;
}

TEST(PredictionStudy, TellsErrorsOfEachPredictorBesideConstantVelocity) {
  write(folder() / "walk.txt", obsmat(30, 100));
  auto config = study_of({"walk.txt", RecordingKind::kPedestrian, "walk"});
  const auto result = run_prediction_study(config, folder());
  ASSERT_TRUE(result) << to_string(result.error());
  ASSERT_EQ(result->cells.size(), 5U);
  for (const StudyCell& cell : result->cells) {
    SCOPED_TRACE(cell.name);
    EXPECT_EQ(cell.n, 3 * 11) << "moments with 8 steps before and 12 after";
    const bool baseline = cell.name == "walk/constant_velocity";
    for (const char* metric : {"ade_less_cv_m", "error_2.4s_less_cv_m"}) {
      EXPECT_EQ(cell.find(metric) == nullptr, baseline) << metric;
    }
    EXPECT_TRUE(cell.find("ade_m")->ci_low) << "three people";
  }
  // Who goes straight on is foretold but for what filters have not settled.
  EXPECT_LT(result->find("walk/constant_velocity")->find("fde_m")->mean, 0.1);
  EXPECT_LT(result->find("walk/companions")->find("ade_m")->mean, 0.2);
  EXPECT_EQ(result->plots.size(), 1U);
  for (const StudyTable& table : result->tables) {
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size()) << table.title;
  }
}

TEST(PredictionStudy, ErrorsAreDistancesFromWhatCame) {
  write(folder() / "turn.txt", obsmat(20, 7));  // one moment: before the turn
  auto config = study_of({"turn.txt", RecordingKind::kPedestrian, "turn"});
  config.predictors = {PredictorKind::kConstantVelocity};
  const auto result = run_prediction_study(config, folder());
  ASSERT_TRUE(result) << to_string(result.error());
  const StudyCell* cell = result->find("turn/constant_velocity");
  ASSERT_TRUE(cell);
  EXPECT_EQ(cell->n, 3);
  // One of three is off by 0.4 m a step: 4.8 m after 12, 1.2 m after 3; half as much and a half
  // step in the mean.
  EXPECT_NEAR(cell->find("fde_m")->mean, 4.8 / 3.0, 0.05);
  EXPECT_NEAR(cell->find("error_1.2s_m")->mean, 1.2 / 3.0, 0.05);
  EXPECT_NEAR(cell->find("ade_m")->mean, 2.6 / 3.0, 0.05);
}

TEST(PredictionStudy, TakesAPartOfTheDrivesOfSheepAndCountsOnlySheep) {
  write(folder() / "drives.csv", drives());
  auto config = study_of({"drives.csv", RecordingKind::kSheep, "flock"});
  config.predictors = {PredictorKind::kConstantVelocity, PredictorKind::kHerd};
  const auto all = run_prediction_study(config, folder());
  config.tracks[0].part = RecordingPart::kEven;
  const auto half = run_prediction_study(config, folder());
  ASSERT_TRUE(all && half);
  const StudyCell* cell = all->find("flock/herd");
  ASSERT_TRUE(cell);
  EXPECT_EQ(cell->n, 2 * half->find("flock/herd")->n);
  EXPECT_EQ(cell->n % 4, 0);
  EXPECT_TRUE(cell->find("ade_m")->ci_low) << "two drives";
  EXPECT_GT(half->find("flock/herd")->find("fde_m")->mean,
            half->find("flock/constant_velocity")->find("fde_m")->mean)
      << "these do not slow down";
}

TEST(PredictionStudy, IsTheSameForAnyNumberOfJobs) {
  write(folder() / "turn.txt", obsmat(40, 20));
  const auto config = study_of({"turn.txt", RecordingKind::kPedestrian, "turn"});
  const auto one = run_prediction_study(config, folder(), 1);
  const auto three = run_prediction_study(config, folder(), 3);
  ASSERT_TRUE(one && three);
  for (std::size_t c = 0; c < one->cells.size(); ++c) {
    ASSERT_EQ(one->cells[c].metrics.size(), three->cells[c].metrics.size());
    for (std::size_t m = 0; m < one->cells[c].metrics.size(); ++m) {
      EXPECT_EQ(one->cells[c].metrics[m].second.mean, three->cells[c].metrics[m].second.mean);
    }
  }
}

TEST(PredictionStudy, AMissingFileIsToldWithItsPathAndItsKey) {
  auto config = study_of({"nowhere/obsmat.txt", RecordingKind::kPedestrian, ""});
  const auto result = run_prediction_study(config, folder());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kFileNotFound);
  const std::string text = to_string(result.error());
  EXPECT_NE(text.find((folder() / "nowhere/obsmat.txt").string()), std::string::npos) << text;
  EXPECT_NE(text.find("tracks[0].file"), std::string::npos) << text;
}

TEST(PredictionStudy, MissingWeightsAreAnError) {
  write(folder() / "walk.txt", obsmat(30, 100));
  auto config = study_of({"walk.txt", RecordingKind::kPedestrian, "walk"});
  config.prediction.learned.weights = "none.weights";
  const auto result = run_prediction_study(config, folder());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kFileNotFound);
}

TEST(PredictionStudy, TooShortATrackIsAnErrorThatSaysSo) {
  write(folder() / "walk.txt", obsmat(19, 100));
  const auto result =
      run_prediction_study(study_of({"walk.txt", RecordingKind::kPedestrian, "walk"}), folder());
  ASSERT_FALSE(result);
  EXPECT_NE(to_string(result.error()).find("nobody was recorded for 20 steps"), std::string::npos);
}

TEST(PredictionStudy, AStepThatTheRecordingDoesNotHaveIsAnError) {
  write(folder() / "walk.txt", obsmat(30, 100));
  auto config = study_of({"walk.txt", RecordingKind::kPedestrian, "walk"});
  config.step_s = 0.3;
  config.times_s = {1.2};
  const auto result = run_prediction_study(config, folder());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kOutOfRange);
}

TEST(PredictionStudy, TimesBetweenStepsAreAnError) {
  PredictionStudyConfig config = study_of({"a", RecordingKind::kPedestrian, ""});
  EXPECT_FALSE(config.check());
  config.times_s = {1.3};
  EXPECT_TRUE(config.check());
  config.times_s = {5.2};
  EXPECT_TRUE(config.check());
}

TEST(PredictionStudy, TheShippedFileNamesScenesAndAllPredictors) {
  const auto config = config::load<PredictionStudyConfig>(kConfigFolder + "/prediction.yaml");
  ASSERT_TRUE(config) << to_string(config.error());
  EXPECT_EQ(config->tracks.size(), 5U);
  EXPECT_EQ(config->predictors.size(), 5U);
}

}  // namespace
}  // namespace headland
