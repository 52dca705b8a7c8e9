// SPDX-License-Identifier: Apache-2.0
#include "control/lookahead_rover/rover_tracker.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/support/allocation_counter.hpp"

namespace headland {
namespace {

constexpr double kDt = 0.05;

Vehicle rover() {
  Vehicle vehicle;
  vehicle.steering = Steering::kDifferential;
  vehicle.min_turning_radius_m = 1.0;
  vehicle.acceleration_mps2 = 1.0;
  vehicle.gear_change_s = 1.0;
  return vehicle;
}

Reference straight(double length) {
  Reference reference;
  reference.path.append_straight({0.0, 0.0, 0.0}, length, 0);
  reference.leg_speed = {1.5};
  return reference;
}

// Forward to the headland, a quarter back to the right, forward again: two cusps.
Reference with_cusps() {
  Reference reference;
  Path& path = reference.path;
  path.append_straight({0.0, 0.0, 0.0}, 6.0, 0);
  path.append({path.end_pose(), 0.5, kPi, Gear::kForward, 1});
  path.append({path.end_pose(), 0.0, 3.0, Gear::kReverse, 1});
  path.append({path.end_pose(), -0.4, 2.0, Gear::kReverse, 1});
  path.append({path.end_pose(), 0.3, 4.0, Gear::kForward, 2});
  path.append_straight(path.end_pose(), 5.0, 2);
  reference.leg_speed = {1.5, 0.8, 1.2};
  return reference;
}

struct Drive {
  std::vector<VehicleState> states;
  std::vector<TrackOutput> outputs;
  double max_error = 0.0;  // distance to the path while tracking [m]
  TrackStatus last = TrackStatus::kTracking;
  const VehicleState& end() const { return states.back(); }
};

Drive drive(RoverTracker& tracker, const Reference& reference, VehicleState state, double seconds) {
  Drive result;
  tracker.start(reference);
  for (int i = 0; i < static_cast<int>(seconds / kDt); ++i) {
    const TrackOutput out = tracker.step(state, kDt);
    const double s = out.s;
    state = step_vehicle(rover(), state, out.command, kDt);
    result.states.push_back(state);
    result.outputs.push_back(out);
    result.last = out.status;
    const double distance =
        reference.path.project(state.pose.position(), std::max(0.0, s - 0.5), s + 0.5).distance;
    result.max_error = std::max(result.max_error, distance);
    if (out.status == TrackStatus::kDone || failed(out.status)) break;
  }
  return result;
}

TEST(RoverTracker, FollowsAStraightLineExactlyAndStopsAtItsEnd) {
  RoverTracker tracker(rover(), {});
  const Reference reference = straight(20.0);
  const Drive result = drive(tracker, reference, {}, 60.0);
  EXPECT_EQ(result.last, TrackStatus::kDone);
  EXPECT_LT(result.max_error, 3e-3);  // past the end by the cycle in which it stops
  EXPECT_NEAR(result.end().pose.x, 20.0, 3e-3);
  EXPECT_NEAR(result.end().pose.y, 0.0, 1e-12);
}

TEST(RoverTracker, ReturnsFromALateralOffsetWithoutOvershoot) {
  RoverTrackerConfig config;
  config.stiffness_1pm = 1.0;
  RoverTracker tracker(rover(), config);
  const Reference reference = straight(40.0);
  VehicleState start;
  start.pose.y = 0.5;
  const Drive result = drive(tracker, reference, start, 60.0);
  double lowest = 0.5;
  for (const VehicleState& state : result.states) lowest = std::min(lowest, state.pose.y);
  EXPECT_GT(lowest, -0.01);
  EXPECT_NEAR(result.end().pose.y, 0.0, 1e-6);
}

TEST(RoverTracker, FadesAnErrorOverTheDistanceOfItsStiffness) {
  // Critically damped: e = e0 (1 + k s) exp(-k s), started along the path.
  RoverTrackerConfig config;
  config.stiffness_1pm = 0.5;
  RoverTracker tracker(rover(), config);
  const Reference reference = straight(40.0);
  VehicleState start;
  start.pose.y = 0.05;
  start.speed = 1.5;
  const Drive result = drive(tracker, reference, start, 20.0);
  for (const VehicleState& state : result.states) {
    const double ks = 0.5 * state.pose.x;
    if (state.pose.x > 35.0) break;
    EXPECT_NEAR(state.pose.y, 0.05 * (1.0 + ks) * std::exp(-ks), 0.002) << state.pose.x;
  }
}

TEST(RoverTracker, FollowsArcsWithinATenthOfAMillimetre) {
  Reference reference;
  reference.path.append_straight({0.0, 0.0, 0.0}, 10.0, 0);
  for (const double curvature : {0.2, -0.2, 0.5}) {
    reference.path.append({reference.path.end_pose(), curvature, 8.0, Gear::kForward, 0});
  }
  reference.path.append_straight(reference.path.end_pose(), 10.0, 0);
  reference.leg_speed = {1.5};
  SpeedLimitConfig limits;
  limits.max_lateral_mps2 = 1000.0;  // at the leg's speed all along
  RoverTracker tracker(rover(), {}, limits);
  const Drive result = drive(tracker, reference, {}, 60.0);
  EXPECT_EQ(result.last, TrackStatus::kDone);
  const std::size_t n = result.states.size();
  for (std::size_t i = 0; i + 3 < n; ++i) {
    const double s = result.outputs[i].s;
    const Projection nearest =
        reference.path.project(result.states[i].pose.position(), s - 0.5, s + 0.5);
    ASSERT_LT(nearest.distance, 5e-4) << s;
  }
}

TEST(RoverTracker, DrivesItsArcsWithinTheLateralAcceleration) {
  Reference reference;
  reference.path.append_straight({0.0, 0.0, 0.0}, 10.0, 0);
  reference.path.append({reference.path.end_pose(), 0.5, 6.0, Gear::kForward, 0});
  reference.path.append({reference.path.end_pose(), -0.4, 6.0, Gear::kReverse, 0});
  reference.leg_speed = {2.0};
  SpeedLimitConfig limits;
  limits.max_lateral_mps2 = 0.6;
  RoverTracker tracker(rover(), {}, limits);
  const Drive result = drive(tracker, reference, {}, 60.0);
  EXPECT_EQ(result.last, TrackStatus::kDone);
  EXPECT_LT(result.max_error, 5e-3);
  double fastest = 0.0;
  for (std::size_t i = 0; i < result.states.size(); ++i) {
    fastest = std::max(fastest, result.states[i].speed);
    if (result.outputs[i].s < 10.05) continue;
    const VehicleState& state = result.states[i];
    ASSERT_LT(std::abs(state.speed * state.yaw_rate), 0.6 * 1.05) << result.outputs[i].s;
  }
  EXPECT_NEAR(fastest, 2.0, 1e-9);
}

TEST(RoverTracker, StopsAndChangesGearAtEveryCusp) {
  RoverTracker tracker(rover(), {});
  const Reference reference = with_cusps();
  const Drive result = drive(tracker, reference, {}, 120.0);
  ASSERT_EQ(result.last, TrackStatus::kDone);
  EXPECT_LT(result.max_error, 0.01);
  const Pose2 goal = reference.path.end_pose();
  EXPECT_LT((result.end().pose.position() - goal.position()).norm(), 0.01);
  EXPECT_NEAR(wrap_angle(result.end().pose.yaw - goal.yaw), 0.0, 0.01);
  int changes = 0;
  int standing = 0;  // cycles of the gear changes
  for (std::size_t i = 1; i < result.outputs.size(); ++i) {
    const bool now = result.outputs[i].status == TrackStatus::kGearChange;
    const bool before = result.outputs[i - 1].status == TrackStatus::kGearChange;
    if (now && !before) ++changes;
    if (now) ++standing;
    // The speed never passes through zero without a standstill.
    EXPECT_GE(result.states[i].speed * result.states[i - 1].speed, -1e-9);
  }
  EXPECT_EQ(changes, 2);
  EXPECT_NEAR(standing * kDt, 2.0 * rover().gear_change_s, 4.0 * kDt);
}

TEST(RoverTracker, DrivesEachSegmentInItsGear) {
  RoverTracker tracker(rover(), {});
  const Reference reference = with_cusps();
  const Drive result = drive(tracker, reference, {}, 120.0);
  for (const TrackOutput& out : result.outputs) {
    if (out.status != TrackStatus::kTracking || out.command.speed == 0.0) continue;
    // At a cusp itself the progress belongs to both gears.
    const Gear just_before = reference.path.at(std::max(0.0, out.s - 1e-6)).gear;
    const Gear just_after = reference.path.at(out.s + 1e-6).gear;
    const Gear driven = out.command.speed > 0.0 ? Gear::kForward : Gear::kReverse;
    EXPECT_TRUE(driven == just_before || driven == just_after) << out.s;
  }
}

TEST(RoverTracker, FollowsInReverseFromAnOffset) {
  Reference reference;
  reference.path.append({{0.0, 0.0, 0.0}, 0.0, 30.0, Gear::kReverse, 0});
  reference.leg_speed = {1.0};
  RoverTracker tracker(rover(), {});
  VehicleState start;
  start.pose = {0.0, 0.3, deg_to_rad(5.0)};
  const Drive result = drive(tracker, reference, start, 60.0);
  EXPECT_EQ(result.last, TrackStatus::kDone);
  EXPECT_NEAR(result.end().pose.x, -30.0, 3e-3);
  EXPECT_NEAR(result.end().pose.y, 0.0, 1e-4);
}

TEST(RoverTracker, TurnsOnTheSpotWhenItFacesTheWrongWay) {
  RoverTracker tracker(rover(), {});
  const Reference reference = straight(15.0);
  for (const double heading_deg : {170.0, -100.0}) {
    VehicleState start;
    start.pose.yaw = deg_to_rad(heading_deg);
    const Drive result = drive(tracker, reference, start, 60.0);
    EXPECT_EQ(result.last, TrackStatus::kDone);
    EXPECT_LT(result.max_error, 0.02);
    EXPECT_EQ(result.states[10].speed, 0.0);  // still pivoting, and in place
    EXPECT_LT(result.states[10].pose.position().norm(), 1e-12);
    EXPECT_NE(result.states[10].pose.yaw, start.pose.yaw);
  }
}

TEST(RoverTracker, ObeysAccelerationAndYawRate) {
  RoverTrackerConfig config;
  config.max_yaw_rate_radps = 0.6;
  RoverTracker tracker(rover(), config);
  Reference reference;
  reference.path.append_straight({0.0, 0.0, 0.0}, 10.0, 0);
  reference.path.append({reference.path.end_pose(), 0.8, 3.0, Gear::kForward, 1});
  reference.path.append_straight(reference.path.end_pose(), 10.0, 2);
  reference.leg_speed = {1.5, 0.7, 1.5};
  const Drive result = drive(tracker, reference, {}, 60.0);
  EXPECT_EQ(result.last, TrackStatus::kDone);
  double before = 0.0;
  for (const TrackOutput& out : result.outputs) {
    EXPECT_LE(std::abs(out.command.yaw_rate), 0.6 + 1e-12);
    EXPECT_LE(std::abs(out.command.speed - before), 1.0 * kDt + 1e-9);
    before = out.command.speed;
  }
}

TEST(RoverTracker, GivesUpFarFromThePath) {
  RoverTracker tracker(rover(), {});
  const Reference reference = straight(20.0);
  VehicleState start;
  start.pose.y = 2.5;
  const Drive result = drive(tracker, reference, start, 10.0);
  EXPECT_EQ(result.last, TrackStatus::kPathLost);
  EXPECT_EQ(result.outputs.back().command.speed, 0.0);
  EXPECT_EQ(result.outputs.back().command.yaw_rate, 0.0);
}

TEST(RoverTracker, StopsOnAMeasurementThatIsNotANumberAndGoesOnAfterIt) {
  RoverTrackerConfig config;
  config.filter.fix_accuracy_m = 0.02;
  RoverTracker tracker(rover(), config);
  const Reference reference = straight(20.0);
  tracker.start(reference);
  tracker.step({}, kDt);
  VehicleState broken;
  broken.pose.x = std::nan("");
  const TrackOutput out = tracker.step(broken, kDt);
  EXPECT_EQ(out.status, TrackStatus::kBadState);
  EXPECT_EQ(out.command.speed, 0.0);
  const TrackOutput after = tracker.step({}, kDt);
  EXPECT_EQ(after.status, TrackStatus::kTracking);
  EXPECT_GT(after.command.speed, 0.0);
}

TEST(RoverTracker, IsDoneAtOnceOnAnEmptyPath) {
  RoverTracker tracker(rover(), {});
  const Reference nothing;
  tracker.start(nothing);
  EXPECT_EQ(tracker.step({}, kDt).status, TrackStatus::kDone);
}

TEST(RoverTracker, DoesNotAllocateInItsTicks) {
  RoverTrackerConfig config;
  config.filter.fix_accuracy_m = 0.02;
  RoverTracker tracker(rover(), config);
  const Reference reference = with_cusps();
  tracker.start(reference);
  RandomStream random(3, "test");
  VehicleState state;
  TrackStatus status = TrackStatus::kTracking;
  const long at_start = testing::allocation_count();
  ASSERT_GT(at_start, 0);  // the counter is in place
  for (int i = 0; i < 3000 && status != TrackStatus::kDone; ++i) {
    VehicleState measured = state;
    measured.pose.x += random.uniform(-0.02, 0.02);
    measured.pose.y += random.uniform(-0.02, 0.02);
    const TrackOutput out = tracker.step(measured, kDt);
    status = out.status;
    state = step_vehicle(rover(), state, out.command, kDt);
  }
  EXPECT_EQ(testing::allocation_count(), at_start);
  EXPECT_EQ(status, TrackStatus::kDone);
}

TEST(RoverTracker, DrivesTheSameWayTwice) {
  RoverTrackerConfig config;
  config.filter.fix_accuracy_m = 0.05;
  RoverTracker tracker(rover(), config);
  const Reference reference = with_cusps();
  const Drive first = drive(tracker, reference, {}, 120.0);
  const Drive second = drive(tracker, reference, {}, 120.0);
  ASSERT_EQ(first.states.size(), second.states.size());
  EXPECT_EQ(first.end().pose.x, second.end().pose.x);
  EXPECT_EQ(first.end().pose.yaw, second.end().pose.yaw);
}

}  // namespace
}  // namespace headland
