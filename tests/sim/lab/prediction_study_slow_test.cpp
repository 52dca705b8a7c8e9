// SPDX-License-Identifier: Apache-2.0
// The shipped study on the recorded tracks: what its predictors are worth.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "core/config/yaml.hpp"
#include "sim/lab/prediction_study.hpp"

namespace headland {
namespace {

double mean_of(const StudyResult& result, const std::string& cell, const std::string& metric) {
  return result.find(cell)->find(metric)->mean;
}

// How much of constant velocity's error is left, at most, with 95 % confidence that it is less.
void expect_better(const StudyResult& result, const std::string& scene,
                   const std::string& predictor, const std::string& metric, double ratio) {
  const double error = mean_of(result, scene + "/" + predictor, metric + "_m");
  const double cv = mean_of(result, scene + "/constant_velocity", metric + "_m");
  EXPECT_LT(error, ratio * cv) << scene << " " << predictor << " " << metric;
  const auto* less = result.find(scene + "/" + predictor)->find(metric + "_less_cv_m");
  EXPECT_LT(*less->ci_high, 0.0) << scene << " " << predictor << " " << metric;
}

TEST(PredictionStudySlow, PredictorsBeatConstantVelocityOnPeopleAndSheep) {
  const char* given = std::getenv("HEADLAND_DATA");
  const std::string root = given ? given : std::string(HEADLAND_SOURCE_DIR) + "/../shared/data";
  if (!std::filesystem::exists(root + "/trajectories")) {
    GTEST_SKIP() << "no " << root << "/trajectories; set HEADLAND_DATA";
  }
  setenv("HEADLAND_DATA", root.c_str(), 1);
  const std::string folder = HEADLAND_SOURCE_DIR "/config/studies";
  const auto config = config::load<PredictionStudyConfig>(folder + "/prediction.yaml");
  ASSERT_TRUE(config) << to_string(config.error());
  const auto result = run_prediction_study(*config, folder, 2);
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_EQ(result->find("eth/companions")->n, 2614);
  for (const char* scene : {"eth", "hotel", "zara01"}) {
    for (const char* metric : {"ade", "fde"}) {
      expect_better(*result, scene, "companions", metric, 0.97);
    }
    EXPECT_LT(mean_of(*result, std::string(scene) + "/orca", "ade_m"),
              mean_of(*result, std::string(scene) + "/constant_velocity", "ade_m"));
  }
  for (const char* scene : {"sheep_held_out", "sheep_fitted"}) {
    for (const char* metric : {"error_1.2s", "error_2.4s", "error_4.8s"}) {
      expect_better(*result, scene, "herd", metric, 0.75);
    }
  }
}

}  // namespace
}  // namespace headland
