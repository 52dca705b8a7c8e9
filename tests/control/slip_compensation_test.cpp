// SPDX-License-Identifier: Apache-2.0
#include "control/slip_compensation.hpp"

#include <gtest/gtest.h>

#include "control/lookahead_rover/rover_tracker.hpp"
#include "control/pure_pursuit/pure_pursuit.hpp"

namespace headland {
namespace {

constexpr double kDt = 0.02;

// Straight, left half circle, straight.
Reference course() {
  Reference reference;
  reference.path.append({{0.0, 0.0, 0.0}, 0.0, 15.0, Gear::kForward, 0});
  reference.path.append({{15.0, 0.0, 0.0}, 0.2, 5.0 * kPi, Gear::kForward, 0});
  reference.path.append({{15.0, 10.0, kPi}, 0.0, 15.0, Gear::kForward, 0});
  reference.leg_speed = {1.5};
  return reference;
}

// Largest cross-track error after the first 5 m, driving with slip that the tracker knows or not.
double worst_error(const Vehicle& vehicle, std::unique_ptr<Tracker> tracker, bool known) {
  const Reference reference = course();
  SlipCompensation compensated(vehicle, std::move(tracker));
  EXPECT_TRUE(compensated.start(reference));
  const Slip slip{0.1, deg_to_rad(3.0), deg_to_rad(2.0)};
  VehicleState state;
  double worst = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    const TrackOutput out = compensated.step({state, known ? slip : Slip{}}, kDt);
    if (out.status == TrackStatus::kDone || failed(out.status)) break;
    state = step_vehicle(vehicle, state, out.command, kDt, slip);
    const Projection p = reference.path.project(state.pose.position(), out.s - 1.0, out.s + 1.0);
    if (p.s > 5.0) worst = std::max(worst, std::abs(p.lateral_error));
  }
  return worst;
}

TEST(SlipCompensation, PurePursuitWithKnownSlipTracksAsWithoutSlip) {
  Vehicle vehicle;
  const auto pursuit = [&] { return std::make_unique<PurePursuit>(vehicle, PurePursuitConfig()); };
  EXPECT_LT(worst_error(vehicle, pursuit(), true), 0.01);
  EXPECT_GT(worst_error(vehicle, pursuit(), false), 0.05);
}

TEST(SlipCompensation, TheRoverTrackerToo) {
  Vehicle vehicle;
  vehicle.steering = Steering::kDifferential;
  vehicle.min_turning_radius_m = 1.0;
  const auto rover = [&] { return std::make_unique<RoverTracker>(vehicle, RoverTrackerConfig()); };
  EXPECT_LT(worst_error(vehicle, rover(), true), 0.01);
  EXPECT_GT(worst_error(vehicle, rover(), false), 0.04);
}

}  // namespace
}  // namespace headland
