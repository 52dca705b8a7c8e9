// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/tracking_study.hpp"

#include <gtest/gtest.h>

#include "core/config/yaml.hpp"

namespace headland {
namespace {

// The shipped study, cut down.
TrackingStudyConfig shipped(int runs) {
  const auto node = config::Node::load("config/studies/tracking.yaml");
  TrackingStudyConfig config;
  EXPECT_TRUE(node);
  const auto read = config::read_into(*node, config);
  EXPECT_TRUE(read) << (read ? "" : to_string(read.error()));
  config.runs_count = runs;
  config.ipopt_runs_count = runs;
  return config;
}

double mean(const StudyResult& result, const std::string& cell, const std::string& metric) {
  const StudyCell* found = result.find(cell);
  EXPECT_NE(found, nullptr) << cell;
  const Statistic* value = found != nullptr ? found->find(metric) : nullptr;
  EXPECT_NE(value, nullptr) << cell << " " << metric;
  return value != nullptr ? value->mean : -1.0;
}

TEST(TrackingStudy, UnknownSlipIsCompensatedAndAStepIsFoundSoonerThanByTheKalmanFilter) {
  TrackingStudyConfig config = shipped(3);
  config.trackers = {StudyTracker::kRhmcRti};
  config.estimators = {StudyEstimator::kNone, StudyEstimator::kEkf, StudyEstimator::kRheStructured};
  config.slips = {StudySlip::kConstant, StudySlip::kStepped};
  config.speeds_mps = {1.5};
  const auto result = run_tracking_study(config, 2);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->cells.size(), 6u);
  const std::string constant = "rhmc_rti/rhe_structured/constant/1.5";
  EXPECT_LT(mean(*result, constant, "overall_rms_m"), 0.02);
  EXPECT_LT(mean(*result, constant, "fishtail_rms_m"), 0.015);
  EXPECT_LT(mean(*result, constant, "cusp_max_m"), 0.04);
  EXPECT_EQ(mean(*result, constant, "wrong_gear_count"), 0.0);
  EXPECT_EQ(mean(*result, constant, "completed_ratio"), 1.0);
  EXPECT_GT(mean(*result, "rhmc_rti/none/constant/1.5", "overall_rms_m"), 0.05);
  const std::string stepped = "rhmc_rti/rhe_structured/stepped/1.5";
  const std::string filtered = "rhmc_rti/ekf/stepped/1.5";
  for (const char* metric : {"overall_rms_m", "max_m"}) {
    EXPECT_LT(mean(*result, stepped, metric), 0.8 * mean(*result, filtered, metric)) << metric;
  }
  EXPECT_LT(mean(*result, stepped, "recovery_s"), 3.0);
}

TEST(TrackingStudy, EveryTrackerDrivesAndTheResultDoesNotDependOnJobs) {
  TrackingStudyConfig config = shipped(1);
  config.course.row_m = 8.0;
  config.estimators = {StudyEstimator::kRheUniform};
  config.slips = {StudySlip::kCrossSlope};
  config.speeds_mps = {0.8};
  const auto one = run_tracking_study(config, 1);
  const auto two = run_tracking_study(config, 2);
  ASSERT_TRUE(one && two);
  for (const StudyCell& cell : one->cells) {
    EXPECT_EQ(mean(*one, cell.name, "completed_ratio"), 1.0) << cell.name;
    EXPECT_EQ(mean(*one, cell.name, "overall_rms_m"), mean(*two, cell.name, "overall_rms_m"));
  }
  EXPECT_EQ(one->cells.front().name, "pp_seed/rhe_uniform/cross_slope/0.8");
  EXPECT_EQ(one->tables.size(), 1u);
  EXPECT_EQ(one->plots.size(), 1u);
}

TEST(TrackingStudy, NamesWhatItLacks) {
  TrackingStudyConfig config = shipped(1);
  config.speeds_mps.clear();
  const auto error = config.check();
  ASSERT_TRUE(error);
  EXPECT_EQ(error->where.key, "speeds_mps");
  config = shipped(1);
  config.course.fishtail_radius_m = 1.0;
  const auto result = run_tracking_study(config);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kPathTooTight);
}

}  // namespace
}  // namespace headland
