// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/polito/drive.hpp"

#include <gtest/gtest.h>

#include "sim/lab/polito/orchard.hpp"

namespace headland {
namespace {

Vehicle rover() {
  Vehicle vehicle;
  vehicle.steering = Steering::kDifferential;
  return vehicle;
}

OrchardPath small_orchard() {
  ParametricOrchardConfig orchard;
  orchard.tree_rows_count = 2;
  orchard.field_width_m = 24.0;
  orchard.field_length_m = 40.0;
  orchard.row_length_m = 20.0;
  return plan_orchard(orchard).value();
}

Reference reference_of(const OrchardPath& plan) {
  return {plan.path, std::vector<double>(plan.legs.size(), 7.0 / 3.6)};
}

double worst(const DrivenTrack& track, const Path& path) {
  double most = 0.0;
  for (const Point2& p : track.positions) {
    most = std::max(most, path.project(p, 0.0, path.length()).distance);
  }
  return most;
}

TEST(DriveOurs, StaysOnThePathWithBothPlants) {
  const OrchardPath plan = small_orchard();
  for (const RoverPlant plant : {RoverPlant::kTurnThenMove, RoverPlant::kArc}) {
    RoverDrive drive;
    drive.plant = plant;
    const DrivenTrack track = drive_ours(drive, {}, reference_of(plan), rover());
    EXPECT_TRUE(track.completed);
    EXPECT_LT(worst(track, plan.path), 2e-3);
  }
}

TEST(DriveSeed, CutsTheCornersALittle) {
  const OrchardPath plan = small_orchard();
  const DrivenTrack track =
      drive_seed({}, {}, waypoints(plan.path, 0.33), plan.path.start_pose().yaw, rover());
  EXPECT_TRUE(track.completed);
  EXPECT_GT(worst(track, plan.path), 0.02);
  EXPECT_LT(worst(track, plan.path), 0.15);
}

TEST(Drives, AreTheSameForTheSameSeedAndOthersForAnother) {
  const OrchardPath plan = small_orchard();
  RoverDrive drive;
  drive.fix_accuracy_m = 0.05;
  RoverTrackerConfig config;
  config.filter.fix_accuracy_m = 0.05;
  const DrivenTrack first = drive_ours(drive, config, reference_of(plan), rover());
  const DrivenTrack again = drive_ours(drive, config, reference_of(plan), rover());
  drive.seed = 2;
  const DrivenTrack other = drive_ours(drive, config, reference_of(plan), rover());
  EXPECT_EQ(first.positions, again.positions);
  EXPECT_NE(first.positions, other.positions);
}

TEST(DriveOurs, LearnsWrongOdometryWithinAFewMetres) {
  const OrchardPath plan = small_orchard();
  RoverDrive drive;
  drive.fix_accuracy_m = 0.02;
  drive.odometry_scale_ratio = 1.02;
  drive.heading_error_rad = deg_to_rad(1.0);
  RoverTrackerConfig config;
  config.filter.fix_accuracy_m = 0.02;
  const DrivenTrack track = drive_ours(drive, config, reference_of(plan), rover());
  EXPECT_TRUE(track.completed);
  EXPECT_LT(worst(track, plan.path), 0.06);
}

TEST(DriveOurs, EndsWhenThePathIsLost) {
  const OrchardPath plan = small_orchard();
  RoverDrive drive;
  drive.heading_error_rad = 0.7;  // and the fixes are taken as exact: nothing learns it
  RoverTrackerConfig config;
  config.lost_beyond_m = 0.2;
  const DrivenTrack track = drive_ours(drive, config, reference_of(plan), rover());
  EXPECT_FALSE(track.completed);
}

}  // namespace
}  // namespace headland
