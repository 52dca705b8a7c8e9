// SPDX-License-Identifier: Apache-2.0
// What a vehicle knows of itself by its lidar and its other sensors.
#include "sim/lab/run/senses.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sim/lab/closed_loop.hpp"
#include "tests/support/coverage_fields.hpp"
#include "tests/support/rover.hpp"

namespace headland {
namespace {

constexpr double kRow = 20.0;     // long [m]
constexpr double kBeside = 0.25;  // the robot begins so far beside the row's middle [m]

Vehicle rover() {
  Vehicle vehicle = test::rover();
  vehicle.battery.capacity_wh = 500.0;
  vehicle.lidar = SensorMount{.x_m = 0.3, .z_m = 1.4};
  return vehicle;
}

Farm orchard() {
  test::FieldShape shape;
  shape.rows = 3;
  shape.length = kRow;
  shape.spacing = 3.8;
  shape.headland = 6.0;
  shape.side = 4.0;
  return test::make_field(shape);
}

// The middle row, from one end to the other.
VehiclePlan one_row(const Vehicle& vehicle, const Farm& farm) {
  VehiclePlan plan;
  plan.id = vehicle.name;
  plan.vehicle = vehicle;
  const Point2 begin = farm.row_parcels[0].rows[1].line.front();
  plan.start = {begin.x(), begin.y(), 0.5 * kPi};
  PlanStage stage;
  stage.path.append_straight(plan.start, kRow, 0);
  plan.stages.push_back(stage);
  plan.legs.push_back({LegKind::kRow, "p/p.2", drive_cost(vehicle, LegKind::kRow, kRow), 1.0, 0});
  plan.start = plan.start * Pose2{0.0, kBeside, 0.0};
  return plan;
}

// Fixes without whole ambiguities, off by the same all the time; the rest is good.
SimulationConfig by_poor_fixes() {
  SimulationConfig config;
  config.step_s = 0.05;
  config.sensors.gnss.noise_m = 0.02;
  config.sensors.gnss.float_fix = {100.0, 3600.0, 0.4};
  config.sensors.heading_noise_deg = 2.0;
  config.sensors.wheel.noise_mps = 0.02;
  config.perception.lidar.azimuth_step_deg = 1.0;
  config.perception.lidar.sub_rays_count = 1;
  config.perception.crop = Crop::kOrchardBare;
  return config;
}

// How far from the row's middle the vehicle is, at most, in its last three quarters [m].
double worst_late(const Run& run) {
  double worst = 0.0;
  for (const TraceRow& row : run.trace) {
    if (row.s_m > 0.25 * kRow) worst = std::max(worst, std::abs(row.cross_track_m));
  }
  return worst;
}

Run drive(const Vehicle& vehicle, const SimulationConfig& config) {
  const Farm farm = orchard();
  return drive_fleet({one_row(vehicle, farm)}, {}, farm, Ground(), config).value().vehicles.front();
}

TEST(Senses, AVehicleWithALidarDrivesARowByItWhereFixesAreTooPoorForThat) {
  SimulationConfig config = by_poor_fixes();
  const auto seen = drive(rover(), config);
  EXPECT_TRUE(seen.metrics.completed) << seen.metrics.reason;
  EXPECT_GE(seen.metrics.rows_seen.scans, 90);
  EXPECT_GE(seen.metrics.rows_seen.valid, 0.95 * seen.metrics.rows_seen.scans);
  EXPECT_LT(worst_late(seen), 0.10);
  config.perception.enabled = false;
  config.control.estimator = EstimatorKind::kLocalizer;
  EXPECT_GT(worst_late(drive(rover(), config)), 0.10);
}

TEST(Senses, RepeatsToTheByte) {
  SimulationConfig config = by_poor_fixes();
  config.perception.period_s = 1.0;
  const auto one = drive(rover(), config);
  const auto again = drive(rover(), config);
  ASSERT_EQ(one.trace.size(), again.trace.size());
  EXPECT_EQ(one.trace.back().x_m, again.trace.back().x_m);
  EXPECT_EQ(one.trace.back().y_m, again.trace.back().y_m);
}

TEST(Senses, WithoutALidarNothingIsSeen) {
  Vehicle vehicle = rover();
  vehicle.lidar.reset();
  const auto run = drive(vehicle, by_poor_fixes());
  EXPECT_EQ(run.metrics.rows_seen.scans, 0);
}

TEST(Senses, TheEstimatorIsTheLocalizerWhereTheVehiclePerceives) {
  Vehicle vehicle = rover();
  ControlConfig control;
  PerceptionConfig perception;
  EXPECT_EQ(estimator_for(vehicle, control, perception), EstimatorKind::kLocalizer);
  control.estimator = EstimatorKind::kEkf;
  EXPECT_EQ(estimator_for(vehicle, control, perception), EstimatorKind::kEkf);
  control.estimator = EstimatorKind::kAuto;
  perception.enabled = false;
  EXPECT_EQ(estimator_for(vehicle, control, perception), EstimatorKind::kSensors);
  perception.enabled = true;
  vehicle.lidar.reset();
  EXPECT_EQ(estimator_for(vehicle, control, perception), EstimatorKind::kSensors);
}

// Nothing but the pose at the start: no fix, no wheels, no scan.
TEST(Senses, AVehicleThatKnowsNoPoseAnyMoreStandsAndGivesUp) {
  Vehicle vehicle = rover();
  vehicle.lidar.reset();
  SimulationConfig config = by_poor_fixes();
  config.control.estimator = EstimatorKind::kLocalizer;
  for (ReadingConfig* sensor : {static_cast<ReadingConfig*>(&config.sensors.gnss),
                                static_cast<ReadingConfig*>(&config.sensors.heading),
                                static_cast<ReadingConfig*>(&config.sensors.wheel),
                                static_cast<ReadingConfig*>(&config.sensors.steering),
                                static_cast<ReadingConfig*>(&config.sensors.imu)}) {
    sensor->enabled = false;
  }
  const auto run = drive(vehicle, config);
  EXPECT_FALSE(run.metrics.completed);
  EXPECT_NE(run.metrics.reason.find("its pose is not known"), std::string::npos)
      << run.metrics.reason;
  EXPECT_GT(run.metrics.duration_s, config.max_lost_s);
  ASSERT_FALSE(run.trace.empty());
  EXPECT_LT(std::abs(run.trace.back().speed_mps), 1e-3);
}

}  // namespace
}  // namespace headland
