// SPDX-License-Identifier: Apache-2.0
// Paths with clothoids: the steering follows the ramp of the curvature.
#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "tests/control/pure_pursuit/drive.hpp"

namespace headland {
namespace {

using namespace pure_pursuit_test;

VehicleState exactly(const VehicleState& state) { return state; }

// Straight, a ramp to `curvature`, a stretch of it, and a ramp back; again to the other side.
Reference smooth_turns(double curvature, double ramp, double speed) {
  Reference reference;
  Path& path = reference.path;
  path.append_straight({}, 10.0, 0);
  for (const double k : {curvature, -curvature}) {
    path.append({path.end_pose(), 0.0, ramp, Gear::kForward, 0, k / ramp});
    path.append({path.end_pose(), k, 6.0, Gear::kForward, 0});
    path.append({path.end_pose(), k, ramp, Gear::kForward, 0, -k / ramp});
  }
  path.append_straight(path.end_pose(), 10.0, 0);
  reference.leg_speed = {speed};
  return reference;
}

// Clothoids from pose to pose, as a roadmap has them: the curvature jumps where they meet.
Reference roadmap_way() {
  Reference reference;
  RandomStream random(7, "clothoid way");
  Pose2 here;
  for (int i = 0; i < 12; ++i) {
    const double turn = random.uniform(-0.8, 0.8);
    const Pose2 there = here * Pose2{25.0 * std::cos(turn), 25.0 * std::sin(turn),
                                     2.0 * turn + random.uniform(-0.3, 0.3)};
    reference.path.append(fit_clothoid(here, there).value().curve, 0);
    here = reference.path.end_pose();
  }
  reference.leg_speed = {2.0};
  return reference;
}

TEST(PurePursuitOnClothoids, FollowsARampThatTheSteeringCanFollowToAMillimetre) {
  const Drive d = drive(study_vehicle(40.0, 0.6), {}, smooth_turns(0.25, 6.0, 1.0));
  EXPECT_EQ(d.last, TrackStatus::kDone);
  EXPECT_LT(d.all.most, 0.002);
  EXPECT_LT(d.end_distance, 0.02);
}

TEST(PurePursuitOnClothoids, SlowsDownForARampThatIsTooSharpForTheSteering) {
  const Vehicle vehicle = study_vehicle(40.0, 0.2);
  const Reference reference = smooth_turns(0.25, 2.0, 1.5);
  const std::vector<SpeedZone> zones = steering_zones(reference, vehicle, {});
  ASSERT_EQ(zones.size(), 4U) << "one for each ramp, none for joints without a step";
  // The steering turns by wheelbase * sharpness rad/m where the path is straight.
  EXPECT_NEAR(zones.front().speed, 0.95 * 0.2 / (2.5 * 0.125), 1e-12);
  EXPECT_NEAR(zones.front().begin_s, 10.0, 1e-12);
  EXPECT_NEAR(zones.front().end_s, 12.0, 1e-12);
  const Drive d = drive(vehicle, {}, reference);
  EXPECT_EQ(d.last, TrackStatus::kDone);
  EXPECT_LT(d.all.most, 0.005);
}

TEST(PurePursuitOnClothoids, PlansARampThatIsAlmostAStepAsAStep) {
  const Vehicle vehicle = study_vehicle(40.0, 0.6);
  SpeedLimitConfig limits;
  limits.least_speed_ratio = 1.0;  // never slows down
  const Drive d = drive(vehicle, {}, smooth_turns(0.25, 0.2, 1.0), {}, exactly, 0.01, limits);
  EXPECT_EQ(d.last, TrackStatus::kDone);
  EXPECT_LT(d.all.most, 0.02);
}

TEST(PurePursuitOnClothoids, DrivesAWayOfClothoidsWithinCentimetres) {
  const Drive d = drive(study_vehicle(40.0, 0.6), {}, roadmap_way());
  EXPECT_EQ(d.last, TrackStatus::kDone);
  EXPECT_LT(d.all.rms(), 0.01);
  EXPECT_LT(d.all.most, 0.04);
}

}  // namespace
}  // namespace headland
