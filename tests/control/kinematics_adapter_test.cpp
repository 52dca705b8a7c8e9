// SPDX-License-Identifier: Apache-2.0
#include "control/kinematics_adapter.hpp"

#include <gtest/gtest.h>

#include "control/lookahead_rover/rover_tracker.hpp"
#include "control/pure_pursuit/pure_pursuit.hpp"
#include "tests/control/receding_horizon/drive.hpp"

namespace headland {
namespace {

using testing::HorizonDrive;

TEST(KinematicsAdapter, PurePursuitDrivesADifferentialVehicle) {
  Vehicle vehicle;
  vehicle.steering = Steering::kDifferential;
  vehicle.min_turning_radius_m = 1.0;
  KinematicsAdapter tracker(vehicle, std::make_unique<PurePursuit>(KinematicsAdapter::twin(vehicle),
                                                                   PurePursuitConfig()));
  for (const Reference& reference :
       {testing::u_turn(3.0, 1.5), testing::fishtail_course(2.0, 2.5, 0.8)}) {
    const HorizonDrive drive = testing::drive(vehicle, tracker, reference, {});
    EXPECT_EQ(drive.last, TrackStatus::kDone);
    EXPECT_LT(drive.rms, 0.02);
    EXPECT_EQ(drive.against_gear, 0);
  }
}

TEST(KinematicsAdapter, TheRoverTrackerDrivesAnAckermannVehicle) {
  Vehicle vehicle;
  vehicle.steering_rate_radps = 3.0;
  vehicle.max_steering_deg = 50.0;
  RoverTrackerConfig config;
  config.pivot_from_deg = 180.0;
  KinematicsAdapter tracker(
      vehicle, std::make_unique<RoverTracker>(KinematicsAdapter::twin(vehicle), config));
  const HorizonDrive drive = testing::drive(vehicle, tracker, testing::u_turn(4.0, 1.0), {});
  EXPECT_EQ(drive.last, TrackStatus::kDone);
  EXPECT_LT(drive.rms, 0.05);
}

TEST(KinematicsAdapter, ATurnOnTheSpotLeavesTheWheelsOfAnAckermannVehicle) {
  Vehicle vehicle;
  KinematicsAdapter tracker(vehicle, std::make_unique<RoverTracker>(
                                         KinematicsAdapter::twin(vehicle), RoverTrackerConfig()));
  const Reference reference = testing::u_turn(4.0, 1.0);
  ASSERT_TRUE(tracker.start(reference));
  VehicleState across;
  across.pose.yaw = 1.5;
  across.steering = 0.2;
  const TrackOutput out = tracker.step(across, testing::kCycle);
  EXPECT_EQ(out.command.speed, 0.0);
  EXPECT_EQ(out.command.steering, 0.2);
}

}  // namespace
}  // namespace headland
