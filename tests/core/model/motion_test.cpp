// SPDX-License-Identifier: Apache-2.0
#include "core/model/motion.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "core/model/kinematics.hpp"

namespace headland {
namespace {

Drive<double> random_drive(RandomStream& random) {
  return make_drive(
      random.uniform(-3.0, 3.0), random.uniform(-0.6, 0.6),
      {random.uniform(-0.1, 0.4), random.uniform(-0.2, 0.2), random.uniform(-0.1, 0.1)});
}

const MotionModel kModels[] = {MotionModel(Steering::kAckermann, 1.5),
                               MotionModel(Steering::kDifferential, 1.2)};

TEST(MotionModel, DerivativesAreThoseOfFiniteDifferences) {
  RandomStream random(1, "drives");
  constexpr double kStep = 1e-6;
  for (const MotionModel& model : kModels) {
    for (int trial = 0; trial < 200; ++trial) {
      const Drive<double> drives[2] = {random_drive(random), random_drive(random)};
      MotionModel::Jacobian<double> by[2];
      const Eigen::Vector3d at =
          model.displacement<double>(drives[0], drives[1], 0.2, by[0], by[1]);
      EXPECT_EQ(at, model.displacement<double>(drives[0], drives[1], 0.2));
      for (int which = 0; which < 2; ++which) {
        for (int i = 0; i < kDriveSize; ++i) {
          Drive<double> more[2] = {drives[0], drives[1]};
          Drive<double> less[2] = {drives[0], drives[1]};
          more[which](i) += kStep;
          less[which](i) -= kStep;
          const Eigen::Vector3d slope = (model.displacement<double>(more[0], more[1], 0.2) -
                                         model.displacement<double>(less[0], less[1], 0.2)) /
                                        (2.0 * kStep);
          EXPECT_LT((slope - by[which].col(i)).norm(), 1e-8) << which << " " << i;
        }
      }
    }
  }
}

TEST(MotionModel, MovesAsTheSimulatedVehicleDoes) {
  RandomStream random(2, "drives");
  for (const Steering steering : {Steering::kAckermann, Steering::kDifferential}) {
    Vehicle vehicle;
    vehicle.steering = steering;
    vehicle.wheelbase_m = 1.5;
    vehicle.max_steering_deg = 80.0;
    const MotionModel model(vehicle);
    for (int trial = 0; trial < 50; ++trial) {
      const Slip slip{random.uniform(-0.1, 0.4), random.uniform(-0.2, 0.2),
                      random.uniform(-0.1, 0.1)};
      VehicleState state;
      state.speed = random.uniform(-2.5, 2.5);
      const double turn = random.uniform(-0.5, 0.5);
      state.steering = state.yaw_rate = turn;
      const Command held{state.speed, turn, turn};
      const VehicleState after = step_vehicle(vehicle, state, held, 0.2, slip);
      const Drive<double> drive = make_drive(state.speed, turn, slip);
      const Eigen::Vector3d moved = model.displacement<double>(drive, drive, 0.2);
      EXPECT_NEAR(moved(0), after.pose.x, 1e-5);
      EXPECT_NEAR(moved(1), after.pose.y, 1e-5);
      EXPECT_NEAR(moved(2), after.pose.yaw, 1e-12);
    }
  }
}

TEST(MotionModel, SimpsonsErrorFallsWithTheFifthPowerOfTheStep) {
  const MotionModel& model = kModels[0];
  const Drive<double> begin = make_drive(1.0, -0.4, {0.1, 0.05, 0.03});
  const Drive<double> end = make_drive(2.0, 0.5, {0.2, -0.05, 0.0});
  const auto in_steps = [&](int steps) {
    Pose2 pose;
    for (int i = 0; i < steps; ++i) {
      const Drive<double> from = begin + (end - begin) * i / steps;
      const Drive<double> to = begin + (end - begin) * (i + 1) / steps;
      const Eigen::Vector3d d = model.displacement<double>(from, to, 0.8 / steps);
      pose = pose * Pose2{d(0), d(1), d(2)};
    }
    return pose;
  };
  const Pose2 exact = in_steps(256);
  const auto miss = [&](int steps) {
    return (in_steps(steps).position() - exact.position()).norm();
  };
  EXPECT_LT(miss(2), miss(1) / 8.0);
  EXPECT_LT(miss(4), miss(2) / 12.0);
  EXPECT_LT(miss(4), 1e-4);
}

TEST(MotionModel, TurnForCancelsTheSlip) {
  RandomStream random(3, "drives");
  for (const MotionModel& model : kModels) {
    for (int trial = 0; trial < 50; ++trial) {
      const Slip slip{random.uniform(-0.1, 0.4), random.uniform(-0.2, 0.2),
                      random.uniform(-0.1, 0.1)};
      const double speed = random.uniform(0.2, 2.0);
      const double curvature = random.uniform(-0.5, 0.5);
      const Drive<double> drive = make_drive(speed, model.turn_for(curvature, speed, slip), slip);
      EXPECT_NEAR(model.yaw_rate<double>(drive), speed * (1.0 - slip.loss_ratio) * curvature,
                  1e-12);
    }
  }
}

}  // namespace
}  // namespace headland
