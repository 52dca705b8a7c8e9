// SPDX-License-Identifier: Apache-2.0
// Seed 002: the tables of its results files (parts B, D, E, F and its fishtail run), and what else
// is known of its drives.
#include <cmath>

#include <gtest/gtest.h>

#include "sim/lab/ebs221/drive.hpp"
#include "sim/lab/ebs221/figures.hpp"
#include "sim/lab/ebs221/tours.hpp"
#include "sim/lab/ebs221_study.hpp"

namespace headland {
namespace {

constexpr double kPrinted = 0.0005;  // half a unit of the paper's last two digits [m]

const StudyResult& study() {
  static const StudyResult result = [] {
    Ebs221StudyConfig config;
    config.runs_count = 1;
    return run_ebs221_study(config).value();
  }();
  return result;
}

const Statistic& value(const std::string& cell, const std::string& metric) {
  static const Statistic kMissing{std::nan("")};
  const StudyCell* found = study().find(cell);
  const Statistic* statistic = found != nullptr ? found->find(metric) : nullptr;
  EXPECT_NE(statistic, nullptr) << cell << " " << metric;
  return statistic != nullptr ? *statistic : kMissing;
}

void expect_rms(const std::string& cell, const std::string& prefix, double all, double row,
                double turn, double tolerance) {
  EXPECT_NEAR(value(cell, prefix + "overall_rms_m").mean, all, tolerance) << cell;
  EXPECT_NEAR(value(cell, prefix + "row_rms_m").mean, row, tolerance) << cell;
  EXPECT_NEAR(value(cell, prefix + "turn_rms_m").mean, turn, tolerance) << cell;
}

TEST(Seed002, ToursCostWhatTheSeedFoundAndLess) {  // (002) parts B and F
  EXPECT_NEAR(value("tour/seed/60deg", "cost_m").mean, 114.41398, 1e-5);
  EXPECT_NEAR(value("tour/seed/30deg", "cost_m").mean, 294.56614, 1e-5);
  EXPECT_NEAR(value("tour/true/60deg", "cost_m").mean, 104.959, 1e-3);
  EXPECT_NEAR(value("tour/true/30deg", "cost_m").mean, 213.635, 1e-3);
}

TEST(Seed002, OrdersOfItsDrivesCostWhatItPrints) {
  const Ebs221StudyConfig config;
  const auto cost = [&](const Ebs221Part& part) {
    return tour_cost(tour_problem(config.field, config.field.radius(part.planned_steering_deg),
                                  TurnCosts::kSeed),
                     alternating_order(part.rows, true));
  };
  EXPECT_NEAR(cost(config.part_d), kPublishedTours[0].cost_m, 1e-4);
  EXPECT_NEAR(cost(config.part_f), kPublishedTours[1].cost_m, 1e-4);
}

TEST(Seed002, TrueTurnCostsFollowTheFormulas) {  // Pi and Omega of the shortest forward turns
  const Ebs221Field field;
  for (const double steering : {60.0, 30.0}) {
    const double r = field.radius(steering);
    for (int jump = 1; jump < field.rows_count; ++jump) {
      const double d = jump * field.row_width_m;
      const double expected = d >= 2.0 * r
                                  ? d + (kPi - 2.0) * r
                                  : r * (3.0 * kPi - 4.0 * std::asin((2.0 * r + d) / (4.0 * r)));
      EXPECT_NEAR(turn_cost(field, r, TurnCosts::kTrue, jump), expected, 1e-9) << jump;
    }
  }
}

TEST(Seed002, DrivesDAndFAsPublished) {  // results files of parts D and F
  for (const PublishedDrive& p : kPublishedDrives) {
    if (std::string(p.cell) == "track/seed/E") continue;
    expect_rms(p.cell, "", p.overall_rms_m, p.row_rms_m, p.turn_rms_m, kPrinted);
    EXPECT_EQ(value(p.cell, "completed_ratio").mean, 1.0) << p.cell;
  }
}

TEST(Seed002, DrivesDAndFToTheExactPath) {
  expect_rms("track/seed/D", "true_", 0.0720, 0.0769, 0.0609, kPrinted);
  expect_rms("track/seed/F", "true_", 0.0192, 0.0123, 0.0229, kPrinted);
}

TEST(Seed002, FishtailRunAsPublishedGearByGear) {  // detailed results of the fishtail run
  EXPECT_NEAR(value("track/seed/fishtail", "forward_rms_m").mean, 0.1943, kPrinted);
  EXPECT_NEAR(value("track/seed/fishtail", "reverse_rms_m").mean, 0.3924, kPrinted);
  EXPECT_EQ(value("track/seed/fishtail", "reverse_count").mean, 3.0);
}

TEST(Seed002, FishtailGoesNowhereUntilItsLastPoint) {
  const Ebs221Field field;
  const double radius = field.radius(60.0);
  const auto links = field_links(field, alternating_order({9, 10}, true));
  const auto points = seed_fishtail_points(links[2], radius);
  ASSERT_EQ(points.size(), 44u);
  EXPECT_LT((points[21] - links[2].from.position()).norm(), 1e-9);
  EXPECT_LT((points[42] - points[0]).norm(), 2.0 * kSeedTurnSpacing + 1e-9);
  EXPECT_GT((points[43] - points[42]).norm(), 2.4);
}

TEST(Seed002, DriveEIsNearThePublishedOne) {
  // Part E leaves its order: the vehicle cannot follow turns of 60 degrees with 30.
  expect_rms("track/seed/E", "", 1.2519, 0.8660, 1.4916, 0.01);
  EXPECT_GT(value("track/seed/E", "true_overall_rms_m").mean, 5.0);
  EXPECT_LT(study().find("track/seed/E")->find("mean_speed_mps")->mean, 1.0 + 1e-9);
}

TEST(Seed002, DriveEFollowsTheRoundingOfItsWaypoints) {
  Ebs221StudyConfig config;
  config.runs_count = 12;
  const auto result = run_ebs221_study(config);
  ASSERT_TRUE(result);
  const Statistic* rms = result->find("track/seed/E/perturbed")->find("overall_rms_m");
  ASSERT_TRUE(rms != nullptr && rms->std);
  EXPECT_GT(*rms->std, 1e-4);  // from errors of 1e-12 m
  EXPECT_LT(*rms->std, 5e-3);
  EXPECT_LT(std::abs(rms->mean - 1.2519), 3.0 * *rms->std);
}

TEST(Seed002, StatedWheelbaseDoesNotGiveThePublishedErrors) {  // Sec. 2.1 says 3 m
  Ebs221StudyConfig config;
  config.runs_count = 1;
  config.wheelbase_m = 3.0;
  const auto result = run_ebs221_study(config);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->find("track/seed/D")->find("overall_rms_m")->mean, 0.0887, kPrinted);
  // Part F has no steering left then, and its error follows the rounding as that of E does.
  EXPECT_NEAR(result->find("track/seed/F")->find("overall_rms_m")->mean, 0.29, 0.02);
}

TEST(Seed002, OursIsFarNearerAtTheSameSpeedWithASteeringRate) {
  EXPECT_LT(value("track/ours/D", "row_rms_m").mean, 0.005);
  EXPECT_LT(value("track/ours/D", "turn_rms_m").mean, 0.005);
  EXPECT_LT(value("track/ours/F", "overall_rms_m").mean, 0.002);
  EXPECT_LT(value("track/ours/fishtail", "overall_rms_m").mean, 0.002);
  EXPECT_LT(value("track/ours/fishtail_30deg", "overall_rms_m").mean, 0.002);
  for (const char* cell :
       {"track/ours/D", "track/ours/F", "track/ours/fishtail", "track/ours/fishtail_30deg"}) {
    EXPECT_EQ(value(cell, "completed_ratio").mean, 1.0) << cell;
    EXPECT_EQ(value(cell, "wrong_gear_count").mean, 0.0) << cell;
    EXPECT_GT(value(cell, "mean_speed_mps").mean, 0.95) << cell;
  }
  // By the seed's rule nobody falls below the chords of its own waypoints.
  EXPECT_NEAR(value("track/ours/D", "seed_overall_rms_m").mean, 0.0333, kPrinted);
}

}  // namespace
}  // namespace headland
