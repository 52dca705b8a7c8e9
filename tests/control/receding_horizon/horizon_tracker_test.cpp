// SPDX-License-Identifier: Apache-2.0
#include "control/receding_horizon/horizon_tracker.hpp"

#include <cstring>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/control/receding_horizon/drive.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

using testing::drive;
using testing::fishtail_course;
using testing::HorizonDrive;
using testing::HorizonWorld;
using testing::kCycle;
using testing::u_turn;

Vehicle rover(Steering steering = Steering::kAckermann) {
  Vehicle vehicle;
  vehicle.steering = steering;
  vehicle.wheelbase_m = 1.5;
  vehicle.max_steering_deg = 40.0;
  vehicle.steering_rate_radps = 0.8;
  vehicle.gear_change_s = 0.5;
  if (steering == Steering::kDifferential) {
    vehicle.min_turning_radius_m = 1.0;
    vehicle.yaw_acceleration_radps2 = 4.0;
  }
  return vehicle;
}

Vehicle sluggish(Vehicle vehicle) {
  vehicle.steering_lag_s = 0.15;
  vehicle.speed_lag_s = 0.25;
  vehicle.steering_dead_time_s = 0.1;
  vehicle.speed_dead_time_s = 0.16;
  return vehicle;
}

HorizonDrive drive_with(const Vehicle& vehicle, const Reference& reference,
                        const HorizonWorld& world = {}, const HorizonConfig& config = {},
                        const VehicleState& start = {}) {
  HorizonTracker tracker(vehicle, config, kCycle);
  return drive(vehicle, tracker, reference, start, world);
}

HorizonWorld slipping(const Slip& slip, bool known) {
  HorizonWorld world;
  world.slip = [slip](double) { return slip; };
  if (!known) {
    world.estimate = [](const VehicleState& truth, const Slip&) { return VehicleEstimate(truth); };
  }
  return world;
}

double distance_to_end(const Reference& reference, const HorizonDrive& d) {
  return (d.end.pose.position() - reference.path.end_pose().position()).norm();
}

TEST(HorizonTracker, DrivesUTurnsOfBothKinds) {
  for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
    for (const Vehicle& vehicle : {rover(steering), sluggish(rover(steering))}) {
      const Reference reference = u_turn(3.0, 1.0);
      const HorizonDrive d = drive_with(vehicle, reference);
      EXPECT_EQ(d.last, TrackStatus::kDone);
      EXPECT_LT(d.rms, 0.005);
      EXPECT_LT(d.largest, 0.02);
      EXPECT_LT(distance_to_end(reference, d), 0.025);
    }
  }
}

TEST(HorizonTracker, DrivesFishtailsAndNeverAgainstTheGear) {
  for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
    for (const Vehicle& vehicle : {rover(steering), sluggish(rover(steering))}) {
      const Reference reference = fishtail_course(2.5, 2.0, 1.0);
      const HorizonDrive d = drive_with(vehicle, reference);
      EXPECT_EQ(d.last, TrackStatus::kDone);
      EXPECT_EQ(d.against_gear, 0);
      EXPECT_LT(d.rms, 0.005);
      EXPECT_LT(d.largest, 0.025);
      EXPECT_LT(distance_to_end(reference, d), 0.025);
    }
  }
}

TEST(HorizonTracker, StopsAtCuspsAndWaitsForTheGear) {
  const Vehicle vehicle = rover();
  const Reference reference = fishtail_course(2.5, 2.0, 1.0);
  HorizonTracker tracker(vehicle, {}, kCycle);
  ASSERT_TRUE(tracker.start(reference));
  VehicleState state;
  int changes = 0;
  int waiting = 0;
  TrackStatus before = TrackStatus::kTracking;
  for (int tick = 0; tick < 5000 && before != TrackStatus::kDone; ++tick) {
    const TrackOutput out = tracker.step(state, kCycle);
    if (out.status == TrackStatus::kGearChange) {
      EXPECT_EQ(out.command.speed, 0.0);
      ++waiting;
      changes += before != out.status ? 1 : 0;
    }
    before = out.status;
    const VehicleState next = step_vehicle(vehicle, state, out.command, kCycle);
    EXPECT_GE(next.speed * state.speed, 0.0);  // never through zero in one tick
    state = next;
  }
  EXPECT_EQ(before, TrackStatus::kDone);
  EXPECT_EQ(changes, 2);
  EXPECT_GE(waiting * kCycle, 2.0 * vehicle.gear_change_s);
}

TEST(HorizonTracker, ADifferentialVehicleTurnsOnTheSpotFirst) {
  for (const double yaw : {2.5, -2.5, kPi, 1.2}) {
    VehicleState start;
    start.pose.yaw = yaw;
    const Reference reference = u_turn(3.0, 1.0);
    HorizonWorld world;
    world.ignore_before = 0.5;
    const HorizonDrive d = drive_with(rover(Steering::kDifferential), reference, world, {}, start);
    EXPECT_EQ(d.last, TrackStatus::kDone) << yaw;
    EXPECT_LT(d.largest, 0.05) << yaw;
  }
}

TEST(HorizonTracker, KnownSlipCostsLittleAndUnknownSlipMore) {
  const Slip slip{0.1, deg_to_rad(3.0), deg_to_rad(2.0)};
  for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
    const Reference reference = u_turn(3.0, 1.0);
    HorizonWorld known = slipping(slip, true);
    HorizonWorld unknown = slipping(slip, false);
    known.ignore_before = unknown.ignore_before = 4.0;  // where the heading is not yet that of slip
    const HorizonDrive told = drive_with(rover(steering), reference, known);
    const HorizonDrive untold = drive_with(rover(steering), reference, unknown);
    EXPECT_EQ(told.last, TrackStatus::kDone);
    EXPECT_LT(told.rms, 0.004);
    EXPECT_GT(untold.rms, 10.0 * told.rms);
    EXPECT_GT(untold.rms, 0.03);
  }
}

TEST(HorizonTracker, RtiAndIpoptDriveTheSame) {
  HorizonConfig ipopt;
  ipopt.solver = HorizonSolverKind::kIpopt;
  const Reference reference = u_turn(3.0, 1.0, 1.0);
  const HorizonDrive one = drive_with(sluggish(rover()), reference);
  const HorizonDrive other = drive_with(sluggish(rover()), reference, {}, ipopt);
  ASSERT_EQ(other.last, TrackStatus::kDone);
  ASSERT_NEAR(static_cast<double>(one.errors.size()), static_cast<double>(other.errors.size()),
              3.0);
  double apart = 0.0;
  const std::size_t ticks = std::min(one.errors.size(), other.errors.size());
  for (std::size_t i = 0; i < ticks; ++i) {
    apart = std::max({apart, std::abs(one.errors[i] - other.errors[i]),
                      std::abs(one.places[i] - other.places[i])});
  }
  EXPECT_LT(apart, 0.001);
}

TEST(HorizonTracker, NeverAllocatesOnADriveWithGearChanges) {
  for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
    const Vehicle vehicle = sluggish(rover(steering));
    const Reference reference = fishtail_course(2.5, 2.0, 1.0);
    HorizonTracker tracker(vehicle, {}, kCycle);
    ASSERT_TRUE(tracker.start(reference));
    CommandDelay delay(vehicle, kCycle);
    VehicleState state;
    TrackOutput out;
    const long before = testing::allocation_count();
    for (int tick = 0; tick < 5000 && out.status != TrackStatus::kDone; ++tick) {
      out = tracker.step(state, kCycle);
      state = step_vehicle(vehicle, state, delay.push(out.command), kCycle);
    }
    EXPECT_EQ(testing::allocation_count(), before);
    EXPECT_EQ(out.status, TrackStatus::kDone);
  }
}

TEST(HorizonTracker, TwoDrivesAreTheSameToTheByte) {
  const Reference reference = fishtail_course(2.0, 3.0, 1.0, 0.5);
  for (const HorizonSolverKind solver : {HorizonSolverKind::kRti, HorizonSolverKind::kIpopt}) {
    HorizonConfig config;
    config.solver = solver;
    const HorizonDrive one = drive_with(rover(), reference, {}, config);
    const HorizonDrive other = drive_with(rover(), reference, {}, config);
    ASSERT_EQ(one.errors.size(), other.errors.size());
    EXPECT_EQ(
        std::memcmp(one.errors.data(), other.errors.data(), one.errors.size() * sizeof(double)), 0);
  }
}

// Arcs, cusps and slivers at random, some beyond what a vehicle at that speed can do.
Reference odd_reference(RandomStream& random, double most_curvature) {
  Reference reference;
  Path& path = reference.path;
  const int pieces = 2 + random.index(8);
  Pose2 at;
  for (int i = 0; i < pieces; ++i) {
    const double length =
        random.uniform() < 0.3 ? random.uniform(1e-7, 0.02) : random.uniform(0.1, 4.0);
    const Gear gear = random.uniform() < 0.7 ? Gear::kForward : Gear::kReverse;
    path.append({at, random.uniform(-most_curvature, most_curvature), length, gear, i});
    at = path.end_pose();
    reference.leg_speed.push_back(random.uniform(0.05, 3.0));
  }
  return reference;
}

TEST(HorizonTracker, CommandsStayFiniteAndWithinLimitsOnOddPaths) {
  RandomStream random(21, "paths");
  HorizonConfig config;
  int done = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const bool ackermann = trial % 2 == 0;
    Vehicle vehicle = rover(ackermann ? Steering::kAckermann : Steering::kDifferential);
    if (trial % 4 < 2) vehicle = sluggish(vehicle);
    const Reference reference = odd_reference(random, ackermann ? 0.5 : 3.0);
    HorizonTracker tracker(vehicle, config, kCycle);
    ASSERT_TRUE(tracker.start(reference)) << trial;
    const Slip slip{random.uniform(-0.1, 0.3), random.uniform(-0.2, 0.2),
                    random.uniform(-0.1, 0.1)};
    CommandDelay delay(vehicle, kCycle);
    VehicleState state;
    state.pose = {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-1, 1)};
    TrackOutput out;
    for (int tick = 0; tick < 2000; ++tick) {
      out = tracker.step({state, slip}, kCycle);
      ASSERT_TRUE(std::isfinite(out.command.speed) && std::isfinite(out.command.steering) &&
                  std::isfinite(out.command.yaw_rate));
      ASSERT_LE(std::abs(out.command.steering), vehicle.max_steering_rad() + 1e-9) << trial;
      ASSERT_LE(std::abs(out.command.yaw_rate), config.max_yaw_rate_radps + 1e-9) << trial;
      ASSERT_LT(std::abs(out.command.speed), 8.0) << trial;
      if (out.status == TrackStatus::kDone || failed(out.status)) break;
      state = step_vehicle(vehicle, state, delay.push(out.command), kCycle, slip);
    }
    done += out.status == TrackStatus::kDone ? 1 : 0;
  }
  EXPECT_GT(done, 15);
}

}  // namespace
}  // namespace headland
