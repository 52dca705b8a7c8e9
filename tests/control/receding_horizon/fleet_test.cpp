// SPDX-License-Identifier: Apache-2.0
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "control/receding_horizon/horizon_estimator.hpp"
#include "control/receding_horizon/horizon_tracker.hpp"
#include "tests/control/estimation/sensed_vehicle.hpp"
#include "tests/control/receding_horizon/drive.hpp"

namespace headland {
namespace {

using testing::kEstimationCycle;

constexpr int kVehicles = 10;

// What a vehicle commands in a drive by its own estimator and tracker.
std::vector<double> commands_of(int number, HorizonSolverKind solver, int ticks) {
  const Vehicle vehicle =
      testing::lagging_vehicle(number % 3 == 0 ? Steering::kDifferential : Steering::kAckermann);
  HorizonConfig config;
  config.solver = solver;
  HorizonTracker tracker(vehicle, config, kEstimationCycle);
  HorizonEstimator estimator(vehicle, {}, {}, kEstimationCycle);
  testing::SensedVehicle truth(vehicle, static_cast<std::uint64_t>(number + 1));
  const Reference reference = number % 2 == 0 ? testing::u_turn(3.5, 1.0 + 0.05 * number, 1.0)
                                              : testing::fishtail_course(3.0, 4.0, 1.0, 0.5);
  std::vector<double> commands;
  if (!tracker.start(reference)) return commands;
  estimator.reset({}, 0.0);
  Estimate estimate;
  const Slip slip{0.02 * number, 0.01 * number, -0.005 * number};
  for (int tick = 0; tick < ticks; ++tick) {
    const TrackOutput out = tracker.step(estimate.vehicle, kEstimationCycle);
    const std::vector<Measurement> measured = truth.step(out.command, slip);
    estimate = estimator.update(measured, out.command, truth.time());
    commands.insert(commands.end(), {out.command.speed, out.command.steering, out.command.yaw_rate,
                                     out.s, static_cast<double>(out.status)});
  }
  return commands;
}

void expect_same_in_threads(HorizonSolverKind solver, int ticks) {
  std::vector<double> together[kVehicles];
  std::vector<std::thread> threads;
  for (int v = 0; v < kVehicles; ++v) {
    threads.emplace_back([&, v] { together[v] = commands_of(v, solver, ticks); });
  }
  for (std::thread& thread : threads) thread.join();
  for (int v = 0; v < kVehicles; ++v) {
    EXPECT_FALSE(together[v].empty()) << v;
    EXPECT_EQ(together[v], commands_of(v, solver, ticks)) << v;  // to the bit
  }
}

TEST(Fleet, TenInThreadsByTheRealTimeIterationDriveAsOneAfterTheOther) {
  expect_same_in_threads(HorizonSolverKind::kRti, 400);
}

TEST(Fleet, TenInThreadsByIpoptDriveAsOneAfterTheOther) {
  expect_same_in_threads(HorizonSolverKind::kIpopt, 100);
}

// The plans of the whole loop lead to the end, and not only to the same bytes.
TEST(Fleet, EveryVehicleDrivesOnItsEstimate) {
  for (int v = 0; v < kVehicles; ++v) {
    const std::vector<double> commands = commands_of(v, HorizonSolverKind::kRti, 600);
    ASSERT_GE(commands.size(), 5U);
    for (std::size_t i = 4; i < commands.size(); i += 5) {
      ASSERT_FALSE(failed(static_cast<TrackStatus>(static_cast<int>(commands[i])))) << v;
    }
    EXPECT_GT(commands[commands.size() - 2], 4.0) << v;  // progress [m]
  }
}

}  // namespace
}  // namespace headland
