// SPDX-License-Identifier: Apache-2.0
#include "control/pure_pursuit/pure_pursuit.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/control/pure_pursuit/drive.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

using namespace pure_pursuit_test;

constexpr double kDt = 0.01;

VehicleState exactly(const VehicleState& state) { return state; }

Reference straight(double length) {
  Reference reference;
  reference.path.append_straight({0.0, 0.0, 0.0}, length, 0);
  reference.leg_speed = {1.0};
  return reference;
}

// Forward round a left arc, back round a right-steered one, forward again.
Reference with_cusps() {
  Reference reference;
  Path& path = reference.path;
  path.append_straight({0.0, 0.0, 0.0}, 5.0, 0);
  path.append({path.end_pose(), 0.4, 3.0, Gear::kForward, 1});
  path.append({path.end_pose(), -0.4, 3.0, Gear::kReverse, 1});
  path.append({path.end_pose(), 0.3, 3.0, Gear::kForward, 1});
  path.append_straight(path.end_pose(), 5.0, 2);
  reference.leg_speed = {1.0, 0.8, 1.0};
  return reference;
}

// Out, and back over the same ground in reverse, and out again.
Reference over_the_same_ground() {
  Reference reference;
  Path& path = reference.path;
  path.append_straight({0.0, 0.0, 0.0}, 8.0, 0);
  path.append({path.end_pose(), 0.0, 6.0, Gear::kReverse, 1});
  path.append_straight(path.end_pose(), 9.0, 2);
  reference.leg_speed = {1.0, 1.0, 1.0};
  return reference;
}

TEST(PurePursuit, StopsWithinTwoCentimetresOfTheEnd) {
  for (const double dt : {0.01, 0.05, 0.1}) {
    for (const double length : {3.0, 7.777}) {
      const Drive d = drive(study_vehicle(40.0, 1.0), {}, straight(length), {}, exactly, dt);
      EXPECT_EQ(d.last, TrackStatus::kDone);
      EXPECT_LT(d.end_distance, 0.02) << dt;
      EXPECT_NEAR(d.states.back().speed, 0.0, 1e-3);
    }
  }
}

TEST(PurePursuit, StopsBeforeItChangesGearAndSteersAtTheStandstill) {
  const Vehicle vehicle = study_vehicle(55.0, 0.5);
  const Reference reference = with_cusps();
  const Drive d = drive(vehicle, {}, reference);
  ASSERT_EQ(d.last, TrackStatus::kDone);
  EXPECT_EQ(d.against_gear, 0);
  EXPECT_LT(d.all.most, 0.03);
  int changes = 0;
  for (std::size_t i = 1; i < d.outputs.size(); ++i) {
    const bool now = d.outputs[i].status == TrackStatus::kGearChange;
    const bool before = d.outputs[i - 1].status == TrackStatus::kGearChange;
    EXPECT_GE(d.states[i].speed * d.states[i - 1].speed, 0.0);  // never through zero in one tick
    if (now) {
      EXPECT_EQ(d.outputs[i].command.speed, 0.0);
    }
    if (now && !before) ++changes;
    if (before && !now) {
      // It drives off with the wheels already turned for the piece behind the cusp.
      const double kappa = reference.path.at(d.outputs[i].s + 1e-6).curvature;
      EXPECT_NEAR(d.states[i - 1].steering, std::atan(vehicle.wheelbase_m * kappa), 0.25);
      EXPECT_GT(std::abs(d.states[i - 1].steering), 0.2);
    }
  }
  EXPECT_EQ(changes, 2);
}

TEST(PurePursuit, StandsForTheGearChangeOrUntilTheWheelsHaveTurned) {
  for (const double seconds : {0.2, 6.0}) {
    Vehicle vehicle = study_vehicle(55.0, 0.5);
    vehicle.gear_change_s = seconds;
    const Drive d = drive(vehicle, {}, with_cusps());
    int ticks = 0;
    double turned = 0.0;
    for (std::size_t i = 1; i < d.outputs.size(); ++i) {
      if (d.outputs[i].status != TrackStatus::kGearChange) continue;
      ++ticks;
      turned += std::abs(d.states[i].steering - d.states[i - 1].steering);
    }
    const double stood = 0.5 * ticks * kDt;  // at each of the two cusps, on average [s]
    EXPECT_GE(stood, seconds);
    EXPECT_GE(stood, 0.5 * turned / vehicle.steering_rate_radps);
    EXPECT_LE(stood, std::max(seconds, 0.5 * turned / vehicle.steering_rate_radps + 1.0) + 0.2);
  }
}

TEST(PurePursuit, DrivesToTheCuspAlthoughThePathBehindItIsNearer) {
  const Reference reference = over_the_same_ground();
  const Drive d = drive(study_vehicle(40.0, 1.0), {}, reference);
  ASSERT_EQ(d.last, TrackStatus::kDone);
  double farthest = 0.0;
  double last_s = 0.0;
  for (std::size_t i = 0; i < d.outputs.size(); ++i) {
    EXPECT_GE(d.outputs[i].s, last_s);  // the progress never goes back, nor jumps
    EXPECT_LT(d.outputs[i].s - last_s, 0.05);
    last_s = d.outputs[i].s;
    if (d.outputs[i].s < 8.0) farthest = std::max(farthest, d.states[i].pose.x);
  }
  EXPECT_NEAR(farthest, 8.0, 0.02);
  EXPECT_NEAR(d.states.back().pose.x, 11.0, 0.02);
  EXPECT_LT(d.all.most, 0.02);
}

TEST(PurePursuit, PassesTheEndOfASegmentBesideItWithoutTurningBack) {
  VehicleState start;
  start.pose = {0.0, 0.4, 0.0};
  const Drive d = drive(study_vehicle(40.0, 1.0), {}, straight(0.5), start, exactly);
  EXPECT_EQ(d.last, TrackStatus::kDone);
  EXPECT_LT(d.outputs.size(), 500U);
  EXPECT_NEAR(d.states.back().pose.x, 0.5, 0.02);
}

TEST(PurePursuit, ReturnsToThePathFromHalfAMetreInBothGears) {
  for (const Gear gear : {Gear::kForward, Gear::kReverse}) {
    for (const double rate : {2.0, 0.6}) {
      Reference reference;
      reference.path.append({{0.0, 0.0, 0.0}, 0.0, 25.0, gear, 0});
      reference.leg_speed = {1.0};
      VehicleState start;
      start.pose.y = 0.5;
      const Drive d = drive(study_vehicle(40.0, rate), {}, reference, start, exactly);
      EXPECT_EQ(d.last, TrackStatus::kDone);
      EXPECT_LT(std::abs(d.states.back().pose.y), 0.001);
      double overshoot = 0.0;
      for (std::size_t i = 0; i < d.states.size(); ++i) {
        overshoot = std::max(overshoot, -d.states[i].pose.y);
        if (d.outputs[i].s > 10.0) {
          ASSERT_LT(std::abs(d.states[i].pose.y), 0.02);
        }
      }
      EXPECT_LT(overshoot, 0.1);
    }
  }
}

TEST(PurePursuit, FollowsArcsAlikeInBothGears) {
  for (const Gear gear : {Gear::kForward, Gear::kReverse}) {
    Reference reference;
    Path& path = reference.path;
    path.append({{1.0, 2.0, 0.7}, 0.0, 5.0, gear, 0});
    path.append({path.end_pose(), 0.3, 6.0, gear, 0});
    path.append({path.end_pose(), -0.25, 6.0, gear, 0});
    reference.leg_speed = {1.0};
    const Drive d = drive(study_vehicle(50.0, 1.0), {}, reference);
    EXPECT_EQ(d.last, TrackStatus::kDone);
    EXPECT_LT(d.all.rms(), 0.003);
  }
}

TEST(PurePursuit, MakesUpForTheLagOfTheSteering) {
  for (const double rate : {0.5, 1.0, 2.0}) {
    for (const double lag : {0.0, 0.1, 0.3}) {
      Vehicle vehicle = study_vehicle(50.0, rate);
      vehicle.steering_lag_s = lag;
      const Drive d = drive(vehicle, {}, with_cusps());
      EXPECT_EQ(d.last, TrackStatus::kDone) << rate << " " << lag;
      EXPECT_LT(d.all.rms(), 0.02) << rate << " " << lag;
      EXPECT_LT(d.all.most, 0.06) << rate << " " << lag;
    }
  }
}

TEST(PurePursuit, ToleratesFixesOfTwoCentimetres) {
  const Vehicle vehicle = study_vehicle(60.0, 1.0);
  const Reference reference = rows({1, 3, 5, 4}, 3.0 / std::tan(deg_to_rad(60.0)), Turn::kDubins);
  PurePursuitConfig config;
  config.filter.fix_accuracy_m = 0.02 * std::sqrt(3.0);  // standard deviation of 2 cm
  RandomStream random(7, "fixes");
  VehicleState start;
  start.pose = reference.path.start_pose();
  const Drive d = drive(vehicle, config, reference, start, [&random](VehicleState state) {
    state.pose.x += 0.02 * random.normal();
    state.pose.y += 0.02 * random.normal();
    return state;
  });
  EXPECT_EQ(d.last, TrackStatus::kDone);
  EXPECT_LT(d.all.rms(), 0.02);
  EXPECT_LT(d.end_distance, 0.05);
}

TEST(PurePursuit, StopsWhenThePathIsLostOrAMeasurementIsNotANumber) {
  PurePursuit tracker(study_vehicle(40.0, 1.0), {});
  EXPECT_EQ(tracker.step({}, kDt).status, TrackStatus::kPathLost);  // not started
  const Reference reference = straight(20.0);
  tracker.start(reference);
  VehicleState far;
  far.pose.y = 3.0;
  far.speed = 1.0;
  const TrackOutput lost = tracker.step(far, kDt);
  EXPECT_EQ(lost.status, TrackStatus::kPathLost);
  EXPECT_EQ(lost.command.speed, 0.0);
  VehicleState broken;
  broken.steering = std::numeric_limits<double>::quiet_NaN();
  const TrackOutput stop = tracker.step(broken, kDt);
  EXPECT_EQ(stop.status, TrackStatus::kBadState);
  EXPECT_EQ(stop.command.speed, 0.0);
  EXPECT_EQ(stop.command.steering, 0.0);
  EXPECT_EQ(tracker.step({}, kDt).status, TrackStatus::kTracking);  // and goes on when back
}

TEST(PurePursuit, AnswersPathsItCannotFollowWithFiniteCommandsWithinTheLimits) {
  RandomStream random(3, "paths");
  const Vehicle vehicle = study_vehicle(30.0, 0.2);  // turns on 4.3 m at best
  for (int trial = 0; trial < 60; ++trial) {
    Reference reference;
    Pose2 from;
    for (int i = 0; i < 8; ++i) {
      const Gear gear = random.normal() > -0.8 ? Gear::kForward : Gear::kReverse;
      const double length = 0.02 + std::abs(2.0 * random.normal());
      reference.path.append({from, random.normal(), length, gear, i});
      reference.leg_speed.push_back(0.3 + std::abs(random.normal()));
      from = reference.path.end_pose();
    }
    const Drive d = drive(vehicle, {}, reference);
    EXPECT_TRUE(d.last == TrackStatus::kDone || failed(d.last)) << trial;
    EXPECT_EQ(d.against_gear, 0);
    for (const TrackOutput& out : d.outputs) {
      ASSERT_TRUE(std::isfinite(out.command.speed));
      ASSERT_LE(std::abs(out.command.steering), vehicle.max_steering_rad());  // false for NaN
    }
  }
}

TEST(PurePursuit, IsDoneAtOnceOnAnEmptyPath) {
  PurePursuit tracker(study_vehicle(40.0, 1.0), {});
  const Reference reference;
  tracker.start(reference);
  EXPECT_EQ(tracker.step({}, kDt).status, TrackStatus::kDone);
}

TEST(PurePursuit, DoesNotAllocateInItsTicks) {
  const Vehicle vehicle = study_vehicle(55.0, 1.0);
  PurePursuit tracker(vehicle, {});
  const Reference reference = with_cusps();
  tracker.start(reference);
  VehicleState state;
  const long before = testing::allocation_count();
  TrackStatus last = TrackStatus::kTracking;
  for (int i = 0; i < 10000 && last != TrackStatus::kDone; ++i) {
    const TrackOutput out = tracker.step(state, kDt);
    last = out.status;
    state = step_vehicle(vehicle, state, out.command, kDt);
  }
  EXPECT_EQ(testing::allocation_count(), before);
  EXPECT_EQ(last, TrackStatus::kDone);
}

TEST(PurePursuit, GivesTheSameDriveTwice) {
  const Drive a = drive(study_vehicle(55.0, 1.0), {}, with_cusps());
  const Drive b = drive(study_vehicle(55.0, 1.0), {}, with_cusps());
  ASSERT_EQ(a.states.size(), b.states.size());
  EXPECT_EQ(a.states.back().pose.x, b.states.back().pose.x);
  EXPECT_EQ(a.states.back().pose.yaw, b.states.back().pose.yaw);
}

TEST(PurePursuit, DrivesItsTurnsWithinTheLateralAcceleration) {
  const Vehicle vehicle = study_vehicle(55.0, 1.0);
  SpeedLimitConfig limits;
  limits.max_lateral_mps2 = 0.3;
  const Reference reference = rows({1, 3, 2}, 2.0, Turn::kDubins);
  const Drive d = drive(
      vehicle, {}, reference, {reference.path.start_pose()},
      [](const VehicleState& s) { return s; }, 0.01, limits);
  EXPECT_EQ(d.last, TrackStatus::kDone);
  double highest = 0.0;
  for (const VehicleState& state : d.states) {
    const double curvature = std::abs(std::tan(state.steering)) / vehicle.wheelbase_m;
    highest = std::max(highest, state.speed * state.speed * curvature);
  }
  // The steering plan bends a little more than the path behind a step.
  EXPECT_LT(highest, 0.3 * 1.2);
  EXPECT_GT(highest, 0.3 * 0.9);
}

}  // namespace
}  // namespace headland
