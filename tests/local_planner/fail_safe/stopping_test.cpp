// SPDX-License-Identifier: Apache-2.0
#include "local_planner/fail_safe/stopping.hpp"

#include <gtest/gtest.h>

#include "core/model/kinematics.hpp"

namespace headland {
namespace {

TEST(Stopping, TheStandardsWorkedCaseIsMet) {
  // vh 1.6, vr 1.0, Tr 0.10, Ts 0.30 (a = vr / Ts), C + Zd + Zr = 0.35: 1.24 m.
  const Stopping stopping(0.10, 1.0 / 0.30, 0.0, 1.0);
  EXPECT_NEAR(stopping.duration(), 0.40, 1e-12);
  EXPECT_NEAR(protective_distance(stopping, 1.6, 0.35), 1.24, 1e-9);
}

TEST(Stopping, AFarmRobotNeedsMetres) {
  // 1 m/s2, Tr 0.3 s, 0.55 m: at 0.5, 1.0, 1.5 and 2.0 m/s.
  const double wanted[] = {2.11, 3.43, 5.00, 6.83};
  for (int i = 0; i < 4; ++i) {
    const Stopping stopping(0.3, 1.0, 0.0, 0.5 * (i + 1));
    EXPECT_NEAR(protective_distance(stopping, 1.6, 0.55), wanted[i], 0.006);
  }
}

TEST(Stopping, IsWhatTheVehicleDoes) {
  Vehicle vehicle;
  vehicle.acceleration_mps2 = 0.8;
  for (const double lag : {0.0, 0.1, 0.4}) {
    vehicle.speed_lag_s = lag;
    for (const double speed : {0.05, 0.3, 1.0, 2.5}) {
      const Stopping stopping(0.3, vehicle.acceleration_mps2, lag, speed);
      VehicleState state;
      state.speed = speed;
      const double dt = 1e-3;
      double time = 0.0;
      while (state.speed > Stopping::kStill && time < 20.0) {
        EXPECT_NEAR(state.speed, stopping.speed(time), 2e-3);
        EXPECT_NEAR(state.pose.x, stopping.way(time), 3e-3);
        state = step_vehicle(vehicle, state, {time < 0.3 ? speed : 0.0, 0.0, 0.0}, dt);
        time += dt;
      }
      EXPECT_NEAR(time, stopping.duration(), lag > 0.0 ? 0.01 : 0.03 / 0.8 + 0.002) << lag;
    }
  }
}

}  // namespace
}  // namespace headland
